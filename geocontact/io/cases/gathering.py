"""gather.toml: the case.toml to be, `[from.<trial>]`, which files each trial comes from, and `[columns]` of some."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import fspath
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.io.cases.case_consistency import KNOWN_SYSTEMS, check_settings, parameters_of
from geocontact.io.cases.case_settings import LARGEST_SETTINGS, CaseSettings, settings_of
from geocontact.io.cases.storage_trial import EXAMPLE as EXAMPLE_COLUMN
from geocontact.io.cases.storage_trial import StorageColumn, columns_of, is_storage
from geocontact.io.cases.trial_sources import EXAMPLE, Source, source_of
from geocontact.io.text.toml_text import toml_of


@dataclass(frozen=True)
class Gathering:
    """Settings of the case to be, the source of each of its trials by id, and what columns of .mot and .sto are."""

    settings: CaseSettings
    sources: Mapping[str, Source]
    columns: tuple[StorageColumn, ...] = ()

    @property
    def sites(self) -> tuple[str, ...]:
        """Of all trials, in the order in which they are named."""
        return tuple(dict.fromkeys(site for source in self.sources.values() for site in source.mats))


def read_gathering(path: Path) -> Gathering:
    """Content of gather.toml; paths in it are meant from its own folder."""
    given = toml_of(path, LARGEST_SETTINGS)
    stated, columns = given.pop("from", None), columns_of(path, given.pop("columns", {}))
    if not isinstance(stated, dict) or not stated:
        raise InputError(path, "", "says nowhere what trials come from", f"write {EXAMPLE}")
    if "layout" in given:
        raise InputError(path, "layout", "is what gathering writes", "leave it out")
    settings = settings_of(given, fspath(path))
    check_settings(settings, path, KNOWN_SYSTEMS)
    parameters_of(settings, path)  # told here and not when the case is read that is written from it
    for name in settings.trials:
        if name not in stated:
            like = next((each for each in stated if isinstance(stated[each], dict)), None)
            wanted = f"write {EXAMPLE}" if like is None else f"write it as [from.{like}]: {', '.join(stated[like])}"
            raise InputError(path, f"[from.{name}]", "is missing", wanted)
    for name in stated:
        if name not in settings.trials:
            what = "neither calibration nor evaluation lists this trial"
            raise InputError(path, f"[from.{name}]", what, f"trials are {', '.join(settings.trials[:30])}")
    sources = {name: source_of(path, name, stated[name]) for name in settings.trials}
    _check_columns(path, sources, columns)
    return Gathering(settings, sources, columns)


def _check_columns(path: Path, sources: Mapping[str, Source], columns: tuple[StorageColumn, ...]) -> None:
    """Columns are told where, and only where, a file without units is read."""
    unnamed = [
        name
        for name, each in sources.items()
        if is_storage(each.inputs) or (each.outputs is not None and is_storage(each.outputs))
    ]
    if unnamed and not columns:
        what = f"is missing: [from.{unnamed[0]}] names a .mot or .sto file, which says no units"
        raise InputError(path, "[columns]", what, f"write [columns] and {EXAMPLE_COLUMN}")
    if columns and not unnamed:
        raise InputError(path, "[columns]", "has no effect: no trial comes from a .mot or .sto file", "leave it out")
