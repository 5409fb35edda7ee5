"""gather.toml: the case.toml to be, and `[from.<trial>]`, which files each trial comes from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import fspath
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.case_consistency import KNOWN_SYSTEMS, check_settings
from geocontact.io.case_settings import LARGEST_SETTINGS, CaseSettings, settings_of
from geocontact.io.toml_text import toml_of

EXAMPLE = '[from.t01] with inputs = "t01.csv" and thigh = "results/t01_thigh"'


@dataclass(frozen=True)
class Source:
    """Where one trial comes from: the file of its inputs, and the folder of each site's mat."""

    inputs: Path
    mats: Mapping[str, Path]


@dataclass(frozen=True)
class Gathering:
    """Settings of the case to be, and the source of each of its trials by id."""

    settings: CaseSettings
    sources: Mapping[str, Source]

    @property
    def sites(self) -> tuple[str, ...]:
        """Of all trials, in the order in which they are named."""
        return tuple(dict.fromkeys(site for source in self.sources.values() for site in source.mats))


def read_gathering(path: Path) -> Gathering:
    """Content of gather.toml; paths in it are meant from its own folder."""
    given = toml_of(path, LARGEST_SETTINGS)
    told = given.pop("from", None)
    if not isinstance(told, dict) or not told:
        raise InputError(path, "", "says nowhere what trials come from", f"write {EXAMPLE}")
    if "layout" in given:
        raise InputError(path, "layout", "is what gathering writes", "leave it out")
    settings = settings_of(given, fspath(path))
    check_settings(settings, path, KNOWN_SYSTEMS)
    for name in settings.trials:
        if name not in told:
            raise InputError(path, f"[from.{name}]", "is missing", f"write {EXAMPLE}")
    for name in told:
        if name not in settings.trials:
            what = "neither calibration nor evaluation lists this trial"
            raise InputError(path, f"[from.{name}]", what, f"trials are {', '.join(settings.trials[:30])}")
    return Gathering(settings, {name: _source(path, name, told[name]) for name in settings.trials})


def _source(path: Path, trial: str, given: Any) -> Source:
    place = f"[from.{trial}]"
    if not isinstance(given, dict) or "inputs" not in given or len(given) < 2:
        raise InputError(path, place, "names no inputs and no mat", f"write {EXAMPLE}")
    for key, value in given.items():
        if not isinstance(value, str) or not value.strip():
            raise InputError(path, f"{place} {key}", f"is {value!r:.60}", "write a path in quotes")
        if key != "inputs" and not key.isidentifier():
            raise InputError(path, f"{place} {key}", "is no name of a site", "letters, digits and _")
    paths = {key: path.parent / value for key, value in given.items()}
    return Source(paths.pop("inputs"), paths)
