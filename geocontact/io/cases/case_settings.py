"""What case.toml says, checked key by key; files that it names are not looked at here."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from os import fspath
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, FiniteFloat, PlainValidator, ValidationError

from geocontact.data.errors import InputError
from geocontact.data.file_names import cannot_be_named
from geocontact.io.text.csv_text import LONGEST_NAME
from geocontact.io.text.toml_text import toml_of

LARGEST_SETTINGS = 1_000_000
"""Bytes of case.toml."""

MOST_TRIALS = 1000
"""Of either kind."""

_FILE_NAME = re.compile(r"\w([\w .+-]*[\w+-])?")


def _name(text: str) -> str:
    if not text.isprintable() or not text.strip() or text != text.strip() or len(text) > LONGEST_NAME:
        raise ValueError(f"expected a name of printable characters, at most {LONGEST_NAME}")
    return text


def _file_name(text: str) -> str:
    """A name that can be part of a file's, on every system, and that leads nowhere else."""
    if not _FILE_NAME.fullmatch(text) or cannot_be_named(text) or ".." in text or len(text) > LONGEST_NAME:
        raise ValueError("expected letters, digits, blanks or any of _ . + - (no path), as in t01")
    return text


def _number_or_word(value: object) -> float | str:
    if isinstance(value, str):
        return _name(value)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError('expected a finite number or a word in quotes, as in level = 0.5 or condition = "locked"')
    return float(value)


Name = Annotated[str, AfterValidator(_name)]
FileName = Annotated[str, AfterValidator(_file_name)]
Covariate = Annotated[float | str, PlainValidator(_number_or_word)]
Trials = Annotated[tuple[FileName, ...], Field(min_length=1, max_length=MOST_TRIALS, strict=False)]


class ParameterSettings(BaseModel):
    """`[parameters.<name>]`; the unit is a label."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    start: FiniteFloat
    lower: float | None = None
    upper: float | None = None
    unit: str = ""
    fixed: bool = False


class MeshSettings(BaseModel):
    """`[mesh.<name>]`: a file inside the folder of the case, its unit, and which faces count ("" for all)."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    file: str
    unit: Literal["m", "cm", "mm", "in"]
    region: str = ""


class CaseSettings(BaseModel):
    """case.toml, with the tables that it names gathered in `tables`."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    format: int
    system: str
    calibration: Trials
    evaluation: Trials
    noise: dict[Name, FiniteFloat] = {}
    constants: dict[Name, FiniteFloat] = {}
    parameters: dict[Name, ParameterSettings] = {}
    trial: dict[FileName, dict[Name, Covariate]] = {}
    layout: dict[FileName, str] = {}
    simulate: str = ""
    inputs: Annotated[tuple[Name, ...], Field(strict=False)] = ()
    outputs: Annotated[tuple[Name, ...], Field(strict=False)] = ()
    mesh: dict[Name, MeshSettings] = {}
    tables: dict[Name, str] = {}

    @property
    def trials(self) -> tuple[str, ...]:
        """Every trial's id, those for calibration first."""
        return (*self.calibration, *self.evaluation)


def read_settings(path: Path) -> CaseSettings:
    """Content of a case.toml of format 1; keys that are not known and values of another type are refused."""
    return settings_of(toml_of(path, LARGEST_SETTINGS), fspath(path))


def settings_of(given: Mapping[str, Any], file: str) -> CaseSettings:
    """The same of what such a file holds."""
    version = given.get("format", "missing")
    if type(version) is not int or version != 1:
        raise InputError(file, "format", f"is {version!r:.40}", "write format = 1, the one that is read here")
    try:
        return CaseSettings.model_validate(_tables_gathered(given))
    except ValidationError as error:
        raise _refusal(error, file) from error


def _tables_gathered(given: Mapping[str, Any]) -> dict[str, Any]:
    """Top-level keys that name a .csv file, moved into `tables`; a key `tables` of the file itself is unknown."""
    fields = set(CaseSettings.model_fields) - {"tables"}
    tables = {
        key: value
        for key, value in given.items()
        if key not in fields and isinstance(value, str) and value.lower().endswith(".csv")
    }
    rest = {f"{key} " if key == "tables" else key: value for key, value in given.items() if key not in tables}
    return {**rest, "tables": tables}


def _refusal(error: ValidationError, file: str) -> InputError:
    """One line for the first thing that is wrong; an unknown key comes before what it may have been meant as."""
    first, *_ = sorted(error.errors(), key=lambda found: found["type"] != "extra_forbidden")
    place = [str(part) for part in first["loc"] if part != "[key]"]
    key = place.pop().strip() if first["type"] in ("extra_forbidden", "missing") else ""
    where = ".".join(place)
    known = CaseSettings if not place else MeshSettings if place[0] == "mesh" else ParameterSettings
    keys = ", ".join(name for name in known.model_fields if name != "tables")
    if first["type"] == "extra_forbidden":
        more = ', or name a table: spheres = "spheres.csv"' if not place else ""
        return InputError(file, where, f"unknown key {key[:80]!r}", f"keys here are {keys}{more}")
    if first["type"] == "missing":
        return InputError(file, where, f"no key '{key}'", f"keys here are {keys}")
    reason = first["msg"].removeprefix("Value error, ")
    return InputError(file, where, f"is {first['input']!r:.60}", reason[0].lower() + reason[1:])
