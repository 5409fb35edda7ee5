"""Tables of foot spheres, the file with the numbers of their law, and parameters of contacts as a calibration wrote
them.
"""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Annotated

import numpy as np
from jaxtyping import Bool, Float
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.magnitude import too_large
from geocontact.data.plausible import LARGEST_MEANT, TOO_LARGE
from geocontact.io.document_errors import BOUNDS, CHECK
from geocontact.io.text.column_names import spelled_as
from geocontact.io.text.csv_text import dict_rows
from geocontact.io.text.file_preflight import read_text_bytes
from geocontact.io.text.plain_table import is_sheet, open_plain
from geocontact.io.text.tables import unequal
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import LENGTH, length_unit, split_header

LARGEST_TABLE = 16_000_000
"""Bytes; some hundred thousand spheres."""

FARTHEST_FOOT = 0.05, 0.35
"""Height [m] and pitch [rad] that a foot may be beside its standing trial; 0.35 rad are 20 degrees."""

PLAUSIBLE = 0.5e-3, 0.5
"""Radii [m] that spheres under a foot have: from a stud of a shoe to the rocker of a prosthesis."""

_COLUMNS = ("px", "py", "pz", "radius", "zone", "k", "b")
_STIFFNESS = re.compile(r"N/m(?:\^(?P<exponent>n|\d+(\.\d+)?))?")
_ZONE = re.compile(r"[\w][\w .+-]{0,39}")


@dataclass(frozen=True)
class SphereTable:
    """A sphere table in SI units.

    Parameters
    ----------
    centre, radius, zone
        In the foot's frame [m].
    stiffness, damping
        Columns k [N/m^n] and b [N s/m], None where the table has none.
    exponent
        The n that the unit of k names, None when it names none.
    """

    centre: Float[np.ndarray, "n 3"]
    radius: Float[np.ndarray, " n"]
    zone: tuple[str, ...]
    stiffness: Float[np.ndarray, " n"] | None
    damping: Float[np.ndarray, " n"] | None
    exponent: float | None


Positive = Annotated[float, Field(gt=0.0)]
NotNegative = Annotated[float, Field(ge=0.0)]


class ZoneLaw(BaseModel):
    """Stiffness [N/m^n], damping [N s/m] and friction, static and kinetic, of a zone; one that bears nothing has 0."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
    k: NotNegative | None = None
    b: NotNegative | None = None
    mu_s: NotNegative | None = None
    mu_k: NotNegative | None = None


class FootLaw(BaseModel):
    """Where a prosthetic foot is on its socket beside a standing trial, as a calibration found it with the law.

    Parameters
    ----------
    height, height_sd
        By which its middle is raised, and the standard deviation of that [m].
    pitch, pitch_sd
        By which it is turned, the toes up, and the standard deviation of that [rad].
    standing
        SHA-256 of the standing trial.
    """

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
    height: float = Field(default=0.0, ge=-FARTHEST_FOOT[0], le=FARTHEST_FOOT[0])
    height_sd: float = Field(default=0.0, ge=0.0, le=FARTHEST_FOOT[0])
    pitch: float = Field(default=0.0, ge=-FARTHEST_FOOT[1], le=FARTHEST_FOOT[1])
    pitch_sd: float = Field(default=0.0, ge=0.0, le=FARTHEST_FOOT[1])
    standing: str | None = Field(default=None, pattern=r"^[0-9a-f]{64}$")


class LawFile(BaseModel):
    """Numbers of a force law, each optional: for all spheres at the top, for one zone in `[zone.NAME]`.

    `[foot]` is no part of the law, but was found with it; a file without it has a foot as its standing trial has it.
    `columns` says that k and b are of one of so many columns of foam; without it they are of one sphere.
    """

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
    k: Positive | None = None
    b: NotNegative | None = None
    n: Positive | None = None
    delta_full: Positive | None = None
    mu_s: NotNegative | None = None
    mu_k: NotNegative | None = None
    v_th: Positive | None = None
    columns: Annotated[int, Field(gt=0)] | None = None
    zone: dict[str, ZoneLaw] = {}
    foot: FootLaw | None = None


def read_spheres(path: str | PathLike[str]) -> SphereTable:
    """Spheres of a CSV: `px [m], py [m], pz [m], radius [m], zone`, and `k [N/m^n]`, `b [N s/m]` where there are any.

    Lengths may be in any unit of length. Without `pz` the spheres lie in z = 0, without `zone` in one zone "foot",
    both with a warning. Refused with its line: what is no finite number, a radius or k that is not positive, b < 0.
    """
    cells = _cells(_table_text(path), fspath(path))
    _warn_defaults(cells)
    radius = cells.lengths("radius")
    cells.refuse("radius", radius, radius <= 0.0, "must be positive")
    _require_plausible(cells, radius)
    depth = cells.lengths("pz") if "pz" in cells.names else np.zeros(len(cells.rows))
    centre = np.column_stack([cells.lengths("px"), cells.lengths("py"), depth])
    zone = cells.zones() if "zone" in cells.names else ("foot",) * len(cells.rows)
    stiffness = cells.numbers("k") if "k" in cells.names else None
    damping = cells.numbers("b") if "b" in cells.names else None
    exponent = None if stiffness is None else _exponent(cells)
    if stiffness is not None:
        cells.refuse("k", stiffness, stiffness <= 0.0, "must be positive")
    if damping is not None:
        if cells.unit("b") != "N s/m":
            raise InputError(cells.file, "", f"column 'b' is in '{cells.unit('b')}'", "write `b [N s/m]`")
        cells.refuse("b", damping, damping < 0.0, "must not be negative")
    return SphereTable(centre, radius, zone, stiffness, damping, exponent)


def read_law(path: str | PathLike[str]) -> LawFile:
    """Numbers of a force law in a .toml: k, b, n, delta_full, mu_s, mu_k, v_th (SI), and k, b, mu_s, mu_k of zones.

    Beside them `[foot]` as `FootLaw` has it.
    """
    file = fspath(path)
    content = toml_of(Path(path), LARGEST_TABLE)
    if not content:
        raise InputError(file, "", "holds no number", "write lines such as n = 1.2")
    try:
        law = LawFile.model_validate(content)
        _warn_of_friction(file, law)
        return law
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        what = "is not known here" if first["type"] == "extra_forbidden" else first["msg"].lower()
        remedy = "it may have k, b, n, delta_full, mu_s, mu_k, v_th, and k, b, mu_s, mu_k in [zone.NAME]"
        if first["type"] in BOUNDS:
            what = f"{first['input']:g} is not {BOUNDS[first['type']]} {next(iter(first['ctx'].values())):g}"
            remedy = CHECK
        if place.startswith("foot"):
            remedy = "[foot] has height, height_sd [m], pitch, pitch_sd [rad] and standing, a SHA-256"
        raise InputError(file, place, what, remedy) from error


def _warn_of_friction(file: str, law: LawFile) -> None:
    """A warning for kinetic friction that is larger than the static one, of all spheres or of a zone."""
    numbers: dict[str, LawFile | ZoneLaw] = {"": law, **{f" [zone.{name}]": zone for name, zone in law.zone.items()}}
    for place, of in numbers.items():
        if of.mu_s is not None and of.mu_k is not None and of.mu_k > of.mu_s:
            what = f"kinetic friction mu_k {of.mu_k:g} is larger than the static mu_s, {of.mu_s:g}; are they exchanged?"
            warnings.warn(f"{file}{place}: {what}", InputWarning, stacklevel=3)


def _table_text(path: str | PathLike[str]) -> str:
    if not is_sheet(path):
        _text(path)
    with open_plain(path, "replace") as stream:
        return stream.read()


def _text(path: str | PathLike[str]) -> str:
    data = read_text_bytes(path, LARGEST_TABLE, "cut it")
    if b"\0" in data or data.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<"):
        raise InputError(path, "", "is not a text table", "give a file of comma-separated columns (UTF-8)")
    return data.decode("utf-8-sig", errors="replace")


@dataclass(frozen=True)
class _Cells:
    """Cells of a table as text, with the line of each row."""

    file: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[int, list[str]], ...]

    def unit(self, name: str) -> str:
        return self.units[self.names.index(name)]

    def column(self, name: str) -> list[tuple[int, str]]:
        place = self.names.index(name)
        return [(line, cells[place]) for line, cells in self.rows]

    def numbers(self, name: str) -> Float[np.ndarray, " n"]:
        """Finite numbers of a column; InputError names the line of the first cell that holds none."""
        values = np.array([self._number(name, line, text) for line, text in self.column(name)])
        self.refuse(name, values, ~np.isfinite(values), "must be finite")
        self.refuse(name, values, too_large(values), "must be of a plausible size")
        return values

    def lengths(self, name: str) -> Float[np.ndarray, " n"]:
        """Numbers of a column in m."""
        return self.numbers(name) * LENGTH[self.length_unit(name)]

    def length_unit(self, name: str) -> str:
        """Key of `LENGTH` that a column is in."""
        written = self.unit(name)
        unit = length_unit(written)
        if unit is None:
            what = f"column '{name}' is in '{written}'" if written else f"column '{name}' has no unit"
            raise InputError(self.file, "", what, f"write e.g. `{name} [m]` (one of {', '.join(LENGTH)})")
        return unit

    def zones(self) -> tuple[str, ...]:
        """Names of the column `zone`, which later name columns of results."""
        for line, text in self.column("zone"):
            if not _ZONE.fullmatch(text):
                remedy = "name zones with up to 40 letters, digits, blanks or . _ + -"
                raise InputError(self.file, f"line {line}", f"zone {text[:40]!r} is not a name", remedy)
        return tuple(text for _, text in self.column("zone"))

    def refuse(self, name: str, values: Float[np.ndarray, " n"], bad: Bool[np.ndarray, " n"], rule: str) -> None:
        """InputError with the line of the first bad value, as it is written there."""
        if bad.any():
            line, text = self.column(name)[int(np.argmax(bad))]
            raise InputError(self.file, f"line {line}", f"{name} is {text[:40]}", f"it {rule}")

    def _number(self, name: str, line: int, text: str) -> float:
        try:
            if "_" in text or not text.isascii():
                raise ValueError(text)
            return float(text)
        except ValueError as error:
            what = f"'{text[:40]}' in column '{name}' is not a number"
            raise InputError(self.file, f"line {line}", what, "use decimal points and fill every cell") from error


def _cells(text: str, file: str) -> _Cells:
    """Header and rows; comments and blank lines are passed over."""
    rows: list[tuple[int, list[str]]] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        cells = [cell.strip() for cell in line.split(",")]
        if rows and len(cells) != len(rows[0][1]):
            raise unequal(len(cells), line, len(rows[0][1]), file, number)
        rows.append((number, cells))
    if len(rows) < 2:
        raise InputError(file, "", "holds no spheres", "write px [m], py [m], pz [m], radius [m], zone and a row each")
    place, header = rows[0]
    given, units = zip(*map(split_header, header), strict=True)
    other = spelled_as(_COLUMNS, given)
    names = tuple(other.get(name, name) for name in given)
    missing = [name for name in ("px", "py", "radius") if name not in names]
    if missing:
        what = f"no column {', '.join(missing)}; columns are: {', '.join(name[:40] for name in names[:30] if name)}"
        raise InputError(file, f"line {place}", what, "write px [m], py [m], pz [m], radius [m], zone")
    for name in _COLUMNS:
        if names.count(name) > 1:
            raise InputError(file, f"line {place}", f"column '{name}' occurs {names.count(name)} times", "keep one")
    return _Cells(file, names, units, tuple(rows[1:]))


def _warn_defaults(cells: _Cells) -> None:
    said = []
    if "pz" not in cells.names:
        said.append("no column 'pz'; the spheres are taken to lie in z = 0")
    if "zone" not in cells.names:
        said.append("no column 'zone'; all spheres are one zone, 'foot'")
    if unknown := [name for name in cells.names if name not in _COLUMNS]:
        said.append(f"column {', '.join(repr(name[:40]) for name in unknown[:30])} is not used")
    for what in said:
        warnings.warn(InputWarning(f"{cells.file}: {what}"), stacklevel=3)


def _require_plausible(cells: _Cells, radius: Float[np.ndarray, " n"]) -> None:
    """Refuse radii that no foot's spheres have, with the unit that is likelier."""
    smallest, largest = PLAUSIBLE
    odd = (radius < smallest) | (radius > largest)
    if not odd.any():
        return
    line, text = cells.column("radius")[int(np.argmax(odd))]
    unit, metres = cells.length_unit("radius"), float(radius[odd][0])
    likelier = [each for each in ("mm", "cm", "m") if smallest <= metres / LENGTH[unit] * LENGTH[each] <= largest]
    what = f"radius is {text[:40]} {unit}, under a foot it is {smallest * 1e3:g} mm to {largest:g} m"
    remedy = f"write radius [{likelier[0]}] if it is in {likelier[0]}" if likelier else "correct it"
    raise InputError(cells.file, f"line {line}", what, remedy)


def _exponent(cells: _Cells) -> float | None:
    """The exponent that the unit of k names, 1 for N/m, None for N/m^n."""
    match = _STIFFNESS.fullmatch(cells.unit("k"))
    if match is None:
        raise InputError(
            cells.file, "", f"column 'k' is in '{cells.unit('k')}'", "write `k [N/m^n]` or, say, [N/m^1.5]"
        )
    written = match["exponent"] or "1"
    return None if written == "n" else float(written)


LARGEST = 1_000_000
"""Bytes."""


def read_contact_parameters(
    path: Path, units: Mapping[str, str], bounds: Mapping[str, tuple[float, float]]
) -> dict[str, float]:
    """Values by name in SI; InputError where one of `units` is missing, twice, in another unit or out of bounds."""
    rows = dict_rows(path, LARGEST, "a table of parameters")
    if not {"parameter", "unit", "value"} <= set(rows.fieldnames or ()):
        remedy = "give parameters.csv of a calibration"
        raise InputError(path, "line 1", "has no columns parameter, unit and value", remedy)
    found: dict[str, float] = {}
    for number, row in enumerate(rows, 2):
        name, unit = row["parameter"], row["unit"]
        if name not in units:
            continue
        if name in found:
            raise InputError(path, f"line {number}", f"{name} is there twice", "keep one of them")
        if unit != units[name]:
            raise InputError(path, f"line {number}", f"{name} is in {unit!r}", f"it is in {units[name]} here")
        try:
            found[name] = float(row["value"])
        except (TypeError, ValueError):
            found[name] = math.nan
        if not math.isfinite(found[name]):
            raise InputError(path, f"line {number}", f"{name} is not a number", "calibrate it, or write its value")
        low, high = bounds[name]
        if not low <= found[name] <= high:
            what = f"{name} {found[name]:g} {unit} is outside {low:g} to {high:g}"
            raise InputError(path, f"line {number}", what, "check value and unit")
    missing = [name for name in units if name not in found]
    if missing:
        raise InputError(path, "", f"no {', '.join(missing)}", "calibrate trials with the exoskeleton")
    return found


def read_contact_intervals(path: Path, names: Collection[str]) -> dict[str, tuple[float, float]]:
    """Ends of the intervals of `names` in SI, of those that have one: a held parameter has none.

    InputError for an interval without room.
    """
    rows = dict_rows(path, LARGEST, "a table of parameters")
    found: dict[str, tuple[float, float]] = {}
    for row in rows:
        if row.get("parameter") in names:
            try:
                low, high = float(row["lower"]), float(row["upper"])
            except (KeyError, TypeError, ValueError):
                continue
            if not (math.isfinite(low) and math.isfinite(high)):
                continue
            if max(abs(low), abs(high)) > LARGEST_MEANT:
                raise InputError(path, row["parameter"], f"an end of its interval {TOO_LARGE}", "calibrate it again")
            if not low < high:
                what = f"no room between {low:g} and {high:g}"
                raise InputError(path, row["parameter"], what, "give lower < upper, or leave both empty")
            found[row["parameter"]] = low, high
    return found
