"""Samples of the start page: one call of each analysis on synthetic files, as `samples.toml` lists them."""

from __future__ import annotations

import re
import shlex
import tomllib
from dataclasses import dataclass
from pathlib import Path

from geocontact.cli.demo import sample_folder

START: dict[str, dict[str, str]] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
"""What somebody has: words of a call by the command of each analysis for it."""
SAMPLES = {command: words for analyses in START.values() for command, words in analyses.items()}


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
    """The sample of an analysis; results of those before it lie below `home`."""
    before = before_of(command)
    places = {"m": sample_folder(), "f": sample_folder() / "forms"}
    places |= {each.replace(" ", "-"): results_of(each, home) for each in before}
    words = (word.format(**places) for word in shlex.split(SAMPLES[command]))
    return Sample(command, (*command.split(), *words), before)


def before_of(command: str) -> tuple[str, ...]:
    """Analyses whose results a sample reads, the first ones first."""
    named = re.findall(r"\{([^}]+)\}", SAMPLES[command])
    direct = [each for each in SAMPLES if each.replace(" ", "-") in named]
    return tuple(dict.fromkeys(earlier for each in direct for earlier in (*before_of(each), each)))


def results_of(command: str, home: Path) -> Path:
    """Folder for the results of a sample that others read."""
    return home / f"sample-{command.replace(' ', '-')}"
