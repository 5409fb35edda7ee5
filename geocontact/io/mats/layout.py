"""layout.toml: what a recording of a mat does not say of itself, or what its user knows better than the file."""

from __future__ import annotations

import math
import re
import unicodedata
from os import fspath
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, PlainValidator, ValidationError

from geocontact.data.errors import InputError
from geocontact.io.text import units
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import DIMENSIONS, LENGTH

_KILOGRAM_PER_CM2 = 9.80665e4
"""Pascals: a kilogram-force per square centimetre, exact by definition."""

_PRESSURE = {name.lower(): factor for name, factor in DIMENSIONS["Pa"].items()} | {
    "kg/cm^2": _KILOGRAM_PER_CM2,
    "kgf/cm^2": _KILOGRAM_PER_CM2,
    "g/cm^2": _KILOGRAM_PER_CM2 * 1e-3,
}


def pressure_unit(text: str) -> float | None:
    """Pascals per unit, whatever case the maker writes it in; None for what is not a unit of pressure."""
    return _PRESSURE.get(_plain(text))


def length_unit(text: str) -> float | None:
    """Metres per unit, abbreviated or in words; None for what is not a unit of length."""
    unit = units.length_unit(text)
    return None if unit is None else LENGTH[unit]


def area_unit(text: str) -> float | None:
    """Square metres per unit: `mm2`, `cm^2`, `in²`, `sq. mm`; None for what is not a unit of area."""
    plain = _plain(text)
    if square := re.fullmatch(r"(?:sq\.?|square)\s*(.*)", plain):
        plain = f"{units.length_unit(square[1])}^2"
    return DIMENSIONS["m^2"].get(plain)


def _plain(text: str) -> str:
    plain = unicodedata.normalize("NFKC", text.strip()).lower().rstrip(".")
    return re.sub(r"(?<=[a-z])\^?2\b", "^2", plain)


LARGEST_LAYOUT = 1_000_000
"""Bytes of layout.toml."""

MOST_LINES = 1000
"""Rows, or columns, of one mat."""


SMALLEST, LARGEST = 1e-6, 1e9
"""Limits of any length, area, rate or pressure of a mat in its usual unit."""


def _positive(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not SMALLEST <= value <= LARGEST:
        raise ValueError(f"expected a positive number, {SMALLEST:g} to {LARGEST:g}")
    return float(value)


def _pitch(value: object) -> tuple[float, float]:
    numbers = value if isinstance(value, list) else [value, value]
    if len(numbers) != 2:
        raise ValueError("expected one number, or [between rows, between columns]")
    return _positive(numbers[0]), _positive(numbers[1])


def _areas(value: object) -> tuple[float, ...]:
    return tuple(_positive(number) for number in (value if isinstance(value, list) else [value]))


def _cells(value: object) -> tuple[tuple[int, int], ...]:
    pairs: list[Any] = value if isinstance(value, list) else [None]
    for pair in pairs:
        if not (isinstance(pair, list) and len(pair) == 2 and all(type(i) is int and i >= 0 for i in pair)):
            raise ValueError("expected cells as [[row, column], ...], both counted from 0")
    cells = tuple((row, column) for row, column in pairs)
    if len(set(cells)) < len(cells):
        raise ValueError("a cell is listed twice")
    return cells


def _mirrored(value: object) -> bool | Turned | None:
    if value is None or isinstance(value, bool):
        return value
    known: dict[object, Turned] = {"rows": "rows", "columns": "columns", "both": "both"}
    if isinstance(value, str) and value in known:
        return known[value]
    raise ValueError('input should be a valid boolean, or "rows", "columns" or "both"')


def _no_flag(value: object) -> object:
    """True and false are equal to 1 and 0, but no numbers."""
    if isinstance(value, bool):
        raise ValueError("expected 0 or 1")
    return value


def _unit(text: str) -> str:
    if pressure_unit(text) is None:
        raise ValueError("expected a unit of pressure: Pa, kPa, mmHg, psi, N/cm2, bar, kg/cm2")
    return text


Turned = Literal["rows", "columns", "both"]
"""What runs backwards: each row, each column, or each of both."""

Count = Annotated[int, Field(ge=1, le=MOST_LINES)]
Cells = Annotated[tuple[tuple[int, int], ...], PlainValidator(_cells)]


class MatLayout(BaseModel):
    """A mat as its user declares it; None or empty where the file of the recording is to say it.

    Parameters
    ----------
    rows, columns
        Of the mat, seen from the side that is pressed.
    pitch_mm
        Between neighbouring rows and between neighbouring columns.
    cell_area_mm2
        Of every cell, or of each in the order of their ids; cells are square where there is no pitch.
    order, serpentine, first_id
        How ids run: along a row or a column, every second one backwards or not, from 0 or 1 on.
    origin
        Corner at which the file's own drawing of the mat has its first value; "top-left" where nothing is said.
    mirrored
        The file shows the mat from behind, so that each row runs the wrong way; rows are turned back. "rows",
        "columns" or "both" say which run the wrong way. A Tekscan file names them itself (MIRROR_ROW, MIRROR_COL):
        true turns back what it names.
    masked, dead
        Cells that are not there and cells that do not work, as [row, column] from 0 in the returned grid.
    sensors
        Row and column of each sensor, first id first, by name of the mat ("left", "right", "mat"): for shapes that no
        order of ids describes. They hold for the returned grid, so that `order`, `origin`, `mirrored` do not apply.
    file
        Path as given, for messages.
    """

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    rows: Count | None = None
    columns: Count | None = None
    pitch_mm: Annotated[tuple[float, float] | None, PlainValidator(_pitch)] = None
    cell_area_mm2: Annotated[tuple[float, ...], PlainValidator(_areas)] = ()
    order: Literal["row", "column"] = "row"
    serpentine: bool = False
    first_id: Annotated[Literal[0, 1], BeforeValidator(_no_flag)] = 1
    origin: Literal["top-left", "top-right", "bottom-left", "bottom-right"] = "top-left"
    mirrored: Annotated[bool | Turned | None, PlainValidator(_mirrored)] = None
    masked: Cells = ()
    dead: Cells = ()
    sensors: dict[str, Cells] = {}
    unit: Annotated[str, AfterValidator(_unit)] | None = None
    saturation_kPa: Annotated[float | None, PlainValidator(_positive)] = None  # noqa: N815 - the unit's own spelling
    rate_Hz: Annotated[float | None, PlainValidator(_positive)] = None  # noqa: N815
    delimiter: Literal[",", ";", "tab"] | None = None
    decimal: Literal[".", ","] | None = None
    file: str = ""

    @property
    def rows_turned(self) -> bool:
        """Whether each row runs backwards in the file."""
        return self.mirrored in (True, "rows", "both")

    @property
    def columns_turned(self) -> bool:
        """Whether each column runs backwards in the file."""
        return self.mirrored in ("columns", "both")

    @property
    def pitch(self) -> tuple[float, float] | None:
        """Between rows and between columns [m]; None where nothing is said."""
        return None if self.pitch_mm is None else (self.pitch_mm[0] * 1e-3, self.pitch_mm[1] * 1e-3)

    @property
    def saturation(self) -> float | None:
        """Pressure at which cells clip [Pa]; None where nothing is said."""
        return None if self.saturation_kPa is None else self.saturation_kPa * 1e3


def read_layout(path: Path) -> MatLayout:
    """Content of a layout.toml; keys that are not known and values that cannot be right are refused."""
    file = fspath(path)
    given = toml_of(path, LARGEST_LAYOUT)
    if "file" in given:
        raise InputError(file, "file", "is not a key of a layout", "name the recording on the command line")
    try:
        layout = MatLayout.model_validate({**given, "file": file})
    except ValidationError as error:
        raise _refusal(error, file) from error
    _require_consistent(layout)
    return layout


def _require_consistent(layout: MatLayout) -> None:
    """What no single key shows: cells outside the grid, areas that leave the pitch open."""
    if len(layout.cell_area_mm2) > 1 and layout.pitch_mm is None:
        raise InputError(layout.file, "cell_area_mm2", "areas differ by cell, so they give no pitch", "add pitch_mm")
    if layout.pitch_mm is not None and any(area > 1.001 * math.prod(layout.pitch_mm) for area in layout.cell_area_mm2):
        what = f"a cell of {max(layout.cell_area_mm2):g} mm^2 does not fit into the pitch of {layout.pitch_mm} mm"
        raise InputError(layout.file, "cell_area_mm2", what, "correct one of them")
    if layout.rows is None or layout.columns is None:
        return
    named = {"masked": layout.masked, "dead": layout.dead} | {f"sensors.{k}": v for k, v in layout.sensors.items()}
    for key, cells in named.items():
        for row, column in cells:
            if row >= layout.rows or column >= layout.columns:
                what = f"cell [{row}, {column}] is outside the {layout.rows} x {layout.columns} grid"
                raise InputError(layout.file, key, what, "rows and columns are counted from 0")


def _refusal(error: ValidationError, file: str) -> InputError:
    """One line for the first thing that is wrong; an unknown key comes before what it may have been meant as."""
    first, *_ = sorted(error.errors(), key=lambda found: found["type"] != "extra_forbidden")
    place = ".".join(str(part) for part in first["loc"] if part != "[key]")
    place = "".join(filter(str.isprintable, place))[:80]
    if first["type"] == "extra_forbidden":
        keys = ", ".join(name for name in MatLayout.model_fields if name != "file")
        return InputError(file, "", f"unknown key {place!r}", f"keys are {keys}")
    reason = first["msg"].removeprefix("Value error, ")
    return InputError(file, place, f"is {first['input']!r:.60}", reason[0].lower() + reason[1:])
