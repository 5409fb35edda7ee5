"""gather.toml: which files each trial comes from, OpenSim's tables among them.

Their columns carry no unit. `[columns]` of gather.toml says which channel each is, in which unit: "angle [deg]". That
is held against what the file tells: whether angles are in degrees by its header, that a column is a moment or a force
by the ending of its name; everything else is in SI units there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import fspath
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.motion import Signals
from geocontact.io.cases.case_settings import (
    KNOWN_SYSTEMS,
    LARGEST_SETTINGS,
    CaseSettings,
    check_settings,
    parameters_of,
    settings_of,
)
from geocontact.io.cases.trial_table import TrialTable
from geocontact.io.text.columns import LARGEST_RADIANS, resolve
from geocontact.io.text.csv_text import Column
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import si_unit, split_header

STORAGE = (".mot", ".sto")
ENDINGS = {"_moment": "N m", "_force": "N"}
"""Endings of a generalised force, as `geocontact id` and OpenSim name it."""
EXAMPLE = '"angle [deg]" = "knee_angle_r"'


@dataclass(frozen=True)
class StorageColumn:
    """A channel with its unit in the file, and the column that holds it."""

    channel: Column
    label: str


def is_storage(path: Path) -> bool:
    """Whether a file is one of OpenSim's tables."""
    return path.suffix.lower() in STORAGE


def columns_of(path: Path, given: Any) -> tuple[StorageColumn, ...]:
    """`[columns]` of gather.toml, the file `path`; InputError for a channel without a known unit."""
    if not isinstance(given, dict):
        raise InputError(path, "columns", "is no table", f"write [columns] and {EXAMPLE}")
    return tuple(_column(path, header, label) for header, label in given.items())


def _column(path: Path, header: str, label: Any) -> StorageColumn:
    place = f"[columns] {header[:80]!r}"
    if not isinstance(label, str) or not label.strip():
        raise InputError(path, place, f"is {label!r:.60}", f"write the name of a column in quotes, as in {EXAMPLE}")
    name, unit = split_header(header)
    known = si_unit(unit)
    if not name.isidentifier() or known is None:
        what = "is no channel with a unit that is known"
        raise InputError(path, place, what, f"write for example {EXAMPLE}")
    si, factor = known
    expected = next((each for ending, each in ENDINGS.items() if label.endswith(ending)), None)
    if expected is not None and unit != expected:
        raise InputError(path, place, f"column {label!r} is in {expected} by its name", f"write [{expected}]")
    if si != "rad" and factor != 1.0:
        raise InputError(path, place, f"is in {unit!r}; OpenSim's tables are in {si}", f"write [{si}]")
    return StorageColumn(Column(name, unit, si, factor), label)


def read_storage_trial(path: Path, columns: Sequence[StorageColumn]) -> TrialTable:
    """Channels of a trial from the columns that a .mot or .sto file has, SI units.

    Columns that are not there are left out; InputError where none is, or where the header contradicts a unit.
    """
    table = read_table(path)
    there = [(one, label) for one in columns if (label := resolve(table, one.label)) is not None]
    if not there:
        what = f"holds none of {listed(tuple(one.label for one in columns))}"
        raise InputError(table.file, "", what, f"columns are: {listed(table.channels)}")
    values = np.column_stack([_values(table, one.channel, label) for one, label in there])
    channels = tuple(one.channel for one, _ in there)
    names, units = tuple(each.name for each in channels), tuple(each.si for each in channels)
    return TrialTable(table.file, Signals(table.time, values, names, units), channels)


def _values(table: TextTable, channel: Column, label: str) -> Float[np.ndarray, " t"]:
    said = table.angles.unit
    if channel.si == "rad" and said not in (None, channel.unit):
        what = f"angles are in {said} by the header, [columns] has {channel.name} in {channel.unit}"
        raise InputError(table.file, f"line {table.angles.line}", what, f'write "{channel.name} [{said}]"')
    values = table.needed(label)
    if channel.unit == "rad" and (largest := float(np.abs(values).max(initial=0.0))) > LARGEST_RADIANS:
        what = f"column {label!r} reaches {largest:.4g}, too much for the radians that [columns] has {channel.name} in"
        raise InputError(table.file, "", what, f'write "{channel.name} [deg]" if they are degrees')
    return values * channel.factor


SOURCES_EXAMPLE = '[from.t01] with inputs = "t01.csv" and outputs = "t01_measured.csv" or SITE = "results/t01_site"'
GOES_WITH = {"plate": "plates", "belt": "plates", "areas": "forces", "threshold": "areas", "force_unit": "forces"}
"""A key that says nothing without another."""
NUMBERS = ("belt", "threshold")
WORDS = ("inputs", "outputs", "plates", "plate", "areas", "forces", "force_unit")


@dataclass(frozen=True)
class PlateSource:
    """What a foot stands on: a file of force plates, which of them, and how fast its ground runs backwards [m/s]."""

    file: Path
    plate: str | None
    belt: float


@dataclass(frozen=True)
class SidesSource:
    """What loads a knee: area.csv and its threshold [m], forces by side and their unit; None where there is one only.

    Without a file of areas they are among the inputs.
    """

    areas: Path | None
    threshold: float | None
    forces: Path
    unit: str | None


@dataclass(frozen=True)
class Source:
    """Where one trial comes from: the file of its inputs, and what is measured beside them.

    `outputs` is a .mot or .sto file, or a .csv table with units like that of a trial.
    """

    inputs: Path
    outputs: Path | None
    mats: Mapping[str, Path]
    plate: PlateSource | None
    sides: SidesSource | None


def source_of(path: Path, trial: str, given: Any) -> Source:
    """Source of a trial from its table in the file `path`; paths in it are meant from the folder of that file."""
    place = f"[from.{trial}]"
    if not isinstance(given, dict) or "inputs" not in given or len(given) < 2:
        raise InputError(
            path, place, "names no inputs and no mat, plates, forces or outputs", f"write {SOURCES_EXAMPLE}"
        )
    for key, value in given.items():
        _check(path, f"{place} {key}", key, value)
    for key, other in GOES_WITH.items():
        if key in given and other not in given:
            raise InputError(path, f"{place} {key}", f"says nothing without {other}", f"name the file of {other}")
    sites = {key: path.parent / value for key, value in given.items() if key not in (*NUMBERS, *WORDS)}
    plate = sides = None
    if "plates" in given:
        plate = PlateSource(path.parent / given["plates"], given.get("plate"), float(given.get("belt", 0.0)))
    if "forces" in given:
        areas = path.parent / given["areas"] if "areas" in given else None
        sides = SidesSource(areas, given.get("threshold"), path.parent / given["forces"], given.get("force_unit"))
    outputs = path.parent / given["outputs"] if "outputs" in given else None
    if outputs is not None and not is_storage(outputs) and outputs.suffix.lower() != ".csv":
        remedy = "give a .mot, .sto or .csv file"
        raise InputError(path, f"{place} outputs", f"'{outputs.suffix}' is not read here", remedy)
    return Source(path.parent / given["inputs"], outputs, sites, plate, sides)


def _check(path: Path, place: str, key: str, value: Any) -> None:
    if key in NUMBERS:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise InputError(path, place, f"is {value!r:.60}", "write a number in SI units")
        return
    if not isinstance(value, str) or not value.strip():
        raise InputError(path, place, f"is {value!r:.60}", "write a path in quotes")
    if not key.isidentifier():
        raise InputError(path, place, "is no name of a site", "letters, digits and _")


@dataclass(frozen=True)
class Gathering:
    """Settings of the case to be, the source of each of its trials by id, and what columns of .mot and .sto are."""

    settings: CaseSettings
    sources: Mapping[str, Source]
    columns: tuple[StorageColumn, ...] = ()

    @property
    def sites(self) -> tuple[str, ...]:
        """Sites of all trials, in the order in which they are named."""
        return tuple(dict.fromkeys(site for source in self.sources.values() for site in source.mats))


def read_gathering(path: Path) -> Gathering:
    """Content of gather.toml; paths in it are meant from its own folder."""
    given = toml_of(path, LARGEST_SETTINGS)
    stated, columns = given.pop("from", None), columns_of(path, given.pop("columns", {}))
    if not isinstance(stated, dict) or not stated:
        raise InputError(path, "", "says nowhere what trials come from", f"write {SOURCES_EXAMPLE}")
    if "layout" in given:
        raise InputError(path, "layout", "is what gathering writes", "leave it out")
    settings = settings_of(given, fspath(path))
    check_settings(settings, path, KNOWN_SYSTEMS)
    parameters_of(settings, path)  # told here and not when the case is read that is written from it
    for name in settings.trials:
        if name not in stated:
            like = next((each for each in stated if isinstance(stated[each], dict)), None)
            wanted = (
                f"write {SOURCES_EXAMPLE}" if like is None else f"write it as [from.{like}]: {', '.join(stated[like])}"
            )
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
        raise InputError(path, "[columns]", what, f"write [columns] and {EXAMPLE}")
    if columns and not unnamed:
        raise InputError(path, "[columns]", "has no effect: no trial comes from a .mot or .sto file", "leave it out")
