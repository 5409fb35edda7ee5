"""gather.toml: the case.toml to be, and `[from.<trial>]`, which files each trial comes from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import fspath
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.io.cases.case_consistency import KNOWN_SYSTEMS, check_settings
from geocontact.io.cases.case_settings import LARGEST_SETTINGS, CaseSettings, settings_of
from geocontact.io.cases.trial_sources import EXAMPLE, Source, source_of
from geocontact.io.text.toml_text import toml_of


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
    stated = given.pop("from", None)
    if not isinstance(stated, dict) or not stated:
        raise InputError(path, "", "says nowhere what trials come from", f"write {EXAMPLE}")
    if "layout" in given:
        raise InputError(path, "layout", "is what gathering writes", "leave it out")
    settings = settings_of(given, fspath(path))
    check_settings(settings, path, KNOWN_SYSTEMS)
    for name in settings.trials:
        if name not in stated:
            raise InputError(path, f"[from.{name}]", "is missing", f"write {EXAMPLE}")
    for name in stated:
        if name not in settings.trials:
            what = "neither calibration nor evaluation lists this trial"
            raise InputError(path, f"[from.{name}]", what, f"trials are {', '.join(settings.trials[:30])}")
    return Gathering(settings, {name: source_of(path, name, stated[name]) for name in settings.trials})
