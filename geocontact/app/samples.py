"""Samples of the start page: one call of each analysis on synthetic files, as `samples.toml` lists them."""

from __future__ import annotations

import re
import shlex
import tomllib
from dataclasses import dataclass
from pathlib import Path

from geocontact.app.sample_files import write_files
from geocontact.cli.demo import sample_folder

_LISTED = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
SAMPLES: dict[str, str] = _LISTED["samples"]
"""Words of a call by the command of its analysis."""
START: dict[str, list[str]] = _LISTED["start"]
"""What somebody has, and the analyses for it."""


@dataclass(frozen=True)
class Sample:
    """A call that can be run.

    Parameters
    ----------
    command
        Its analysis.
    words
        All words but the folder of the results; files as paths.
    before
        Analyses whose samples are run before, in this order; their results lie in `results_of`.
    """

    command: str
    words: tuple[str, ...]
    before: tuple[str, ...]


def sample(command: str, home: Path) -> Sample:
    """The sample of an analysis, whose own files are written below `home`."""
    text = SAMPLES[command]
    before = before_of(command)
    places = {"m": sample_folder(), "f": home / "sample-files"}
    places |= {each: results_of(each, home) for each in before}
    if "{f}" in text:
        write_files(places["f"])
    named = {name: f"{{{k}}}" for k, name in enumerate(places)}  # a name may have a blank
    for name, short in named.items():
        text = text.replace(f"{{{name}}}", short)
    words = [
        re.sub(r"\{(\d+)\}", lambda found: str(list(places.values())[int(found[1])]), w) for w in shlex.split(text)
    ]
    return Sample(command, (*command.split(), *words), before)


def before_of(command: str) -> tuple[str, ...]:
    """Analyses whose results a sample reads, the first ones first."""
    found: dict[str, None] = {}
    for each in re.findall(r"\{([^}]+)\}", SAMPLES[command]):
        if each in SAMPLES:
            found |= dict.fromkeys((*before_of(each), each))
    return tuple(found)


def results_of(command: str, home: Path) -> Path:
    """Folder for the results of a sample that others read."""
    return home / f"sample-{command.replace(' ', '-')}"
