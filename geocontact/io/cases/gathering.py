"""gather.toml: which files each trial comes from, OpenSim's tables among them.

Their columns carry no unit. `[columns]` of gather.toml says which channel each is, in which unit: "angle [deg]". That
is held against what the file tells: whether angles are in degrees by its header, that a column is a moment or a force
by the ending of its name; everything else is in SI units there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import fspath
from pathlib import Path
from typing import Annotated

import numpy as np
from jaxtyping import Float
from pydantic import AfterValidator, ConfigDict, Field, FiniteFloat, PlainValidator, model_validator

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
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Beside, Document, Holds, Text, Word, checked
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


def _columns(given: object) -> tuple[StorageColumn, ...]:
    if not isinstance(given, dict):
        raise refusal("is not a table", f"write [columns] and {EXAMPLE}")
    return tuple(_column(header, label) for header, label in given.items())


def _column(header: str, label: object) -> StorageColumn:
    if not isinstance(label, str) or not label.strip():
        remedy = f"write the name of a column in quotes, as in {EXAMPLE}"
        raise refusal(f"is {label!r:.60}", remedy, at=(header,))
    name, unit = split_header(header)
    known = si_unit(unit)
    if not name.isidentifier() or known is None:
        raise refusal("is not a channel with a known unit", f"write for example {EXAMPLE}", at=(header,))
    si, factor = known
    expected = next((each for ending, each in ENDINGS.items() if label.endswith(ending)), None)
    if expected is not None and unit != expected:
        raise refusal(f"column {label!r:.60} is in {expected} by its name", f"write [{expected}]", at=(header,))
    if si != "rad" and factor != 1.0:
        raise refusal(f"is in {unit!r}; OpenSim's tables are in {si}", f"write [{si}]", at=(header,))
    return StorageColumn(Column(name, unit, si, factor), label)


Columns = Annotated[tuple[StorageColumn, ...], PlainValidator(_columns), Holds("names of columns by channel and unit")]
"""`[columns]`: names of columns by channel and unit."""


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


GOES_WITH = {"plate": "plates", "belt": "plates", "areas": "forces", "threshold": "areas", "force_unit": "forces"}
"""A key that has no meaning without another."""


def _outputs(file: Path) -> Path:
    if not is_storage(file) and file.suffix.lower() != ".csv":
        raise refusal(f"'{file.suffix}' is not read here", "give a .mot, .sto or .csv file")
    return file


class Source(Document):
    """Where one trial comes from: the file of its inputs, and what is measured beside them.

    Parameters
    ----------
    inputs
        Time and the inputs of the model: .csv with units, or .mot, .sto with `[columns]`.
    outputs
        A .mot, .sto or .csv file like that of inputs.
    plates
        Force plates, y up: .mot, .sto or .c3d.
    plate
        Name or number of the plate that counts; may be left out where there is one.
    belt
        How fast its ground runs backwards [m/s].
    areas
        `area.csv` of both sides of a knee; left out where areas are among the inputs.
    threshold
        Which of its thresholds [m]; may be left out where there is one.
    forces
        Forces of both sides: `forces.csv` of `geocontact loadcells`, or a table with `medial` and `lateral`.
    force_unit
        Unit of forces where the file does not say it.
    SITE
        Folder with the results of `geocontact mat` for a mat on that site.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Beside]
    inputs: Annotated[Beside, Field(examples=['"t01.csv"'])]
    outputs: Annotated[Beside, AfterValidator(_outputs)] | None = None
    plates: Beside | None = None
    plate: Word | None = None
    belt: FiniteFloat = 0.0
    areas: Beside | None = None
    threshold: FiniteFloat | None = None
    forces: Beside | None = None
    force_unit: Text | None = None

    @property
    def mats(self) -> dict[str, Path]:
        """Folders of mats by site."""
        return self.__pydantic_extra__

    @property
    def unnamed(self) -> bool:
        """Whether one of its files says no units."""
        return any(is_storage(each) for each in (self.inputs, self.outputs) if each is not None)

    @model_validator(mode="after")
    def _require_measured(self) -> Source:
        for site in self.mats:
            if not site.isidentifier():
                raise refusal("is not a name of a site", "letters, digits and _", at=(site,))
        for key, other in GOES_WITH.items():
            if key in self.model_fields_set and getattr(self, other) is None:
                raise refusal(f"has no meaning without {other}", f"name the file of {other}", at=(key,))
        if not self.mats and self.outputs is None and self.plates is None and self.forces is None:
            what = "names no mat, plates, forces or outputs beside its inputs"
            raise refusal(what, 'add outputs = "t01_measured.csv" or SITE = "results/t01_site"', at=("",))
        return self


class Sources(Document):
    """What gather.toml has besides the keys of case.toml.

    Parameters
    ----------
    from
        Sources of each trial that calibration or evaluation lists, by its id.
    columns
        Where a .mot or .sto file is read: which channel each of its columns is, `"angle [deg]" = "knee_angle_r"`.
    """

    sources: Annotated[dict[str, Source], Field(alias="from")]
    columns: Columns = ()


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
    own = {key: given.pop(key) for key in Sources.by_key() if key in given}
    described: Sources = checked(path, Sources, own)
    if "layout" in given:
        raise InputError(path, "layout", "is written by geocontact gap gather", "leave it out")
    settings = settings_of(given, fspath(path))
    check_settings(settings, path, KNOWN_SYSTEMS)
    parameters_of(settings, path)  # refused here and not when the case is read that is written from it
    lacking = next((name for name in settings.trials if name not in described.sources), None)
    if lacking is not None:
        like, source = next(iter(own["from"].items()))
        raise InputError(path, f"[from.{lacking}]", "is missing", f"write it as [from.{like}]: {', '.join(source)}")
    odd = next((name for name in described.sources if name not in settings.trials), None)
    if odd is not None:
        what = "neither calibration nor evaluation lists this trial"
        raise InputError(path, f"[from.{odd}]", what, f"trials are {', '.join(settings.trials[:30])}")
    _check_columns(path, described)
    return Gathering(settings, {name: described.sources[name] for name in settings.trials}, described.columns)


def _check_columns(path: Path, described: Sources) -> None:
    """Columns are stated where, and only where, a file without units is read."""
    unnamed = next((name for name, each in described.sources.items() if each.unnamed), None)
    if unnamed is not None and not described.columns:
        what = f"is missing: [from.{unnamed}] names a .mot or .sto file, which says no units"
        raise InputError(path, "[columns]", what, f"write [columns] and {EXAMPLE}")
    if described.columns and unnamed is None:
        raise InputError(path, "[columns]", "has no effect: no trial comes from a .mot or .sto file", "leave it out")
