"""Units at the door: how much of the SI unit one unit of a file is."""

from __future__ import annotations

import re
import unicodedata
from math import pi

LENGTH: dict[str, float] = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "um": 1e-6}
"""Metres per unit of length."""

_IN_WORDS: dict[str, str] = {
    "meters": "m",
    "metres": "m",
    "centimeters": "cm",
    "centimetres": "cm",
    "millimeters": "mm",
    "millimetres": "mm",
    "inches": "in",
    "micrometers": "um",
    "micrometres": "um",
    "microns": "um",
}

_SHORTEST = 4
"""Letters that a word for a unit may be cut to: the parameter UNITS of a .c3d file often holds four (`mete`)."""

ANGLE: dict[str, float] = {"rad": 1.0, "deg": pi / 180.0}
"""Radians per unit of angle."""

MESH_UNITS = ("m", "cm", "mm", "in")
"""Units a mesh may be declared in; the keys of `LENGTH` that surfaces of implants and bodies come in."""

_POUND, _GRAVITY, _INCH = 0.45359237, 9.80665, 0.0254
"""Kilograms, m/s^2 and metres: exact by definition."""

_MMHG = 13595.1 * _GRAVITY * 1e-3
"""Pascals: a millimetre of mercury of conventional density (ISO 80000-4)."""

DIMENSIONS: dict[str, dict[str, float]] = {
    "-": {"-": 1.0, "1": 1.0, "%": 1e-2},
    "m": LENGTH,
    "rad": ANGLE,
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0},
    "kg": {"kg": 1.0, "g": 1e-3, "lb": _POUND},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "kgf": _GRAVITY, "lbf": _POUND * _GRAVITY},
    "Pa": {
        "Pa": 1.0,
        "hPa": 1e2,
        "kPa": 1e3,
        "MPa": 1e6,
        "GPa": 1e9,
        "mbar": 1e2,
        "bar": 1e5,
        "mmHg": _MMHG,
        "psi": _POUND * _GRAVITY / _INCH**2,
        "N/m^2": 1.0,
        "N/cm^2": 1e4,
        "N/mm^2": 1e6,
    },
    "m^2": {"m^2": 1.0, "cm^2": 1e-4, "mm^2": 1e-6, "in^2": _INCH**2},
    "m^3": {"m^3": 1.0, "cm^3": 1e-6, "mm^3": 1e-9},
    "N m": {"N m": 1.0, "N cm": 1e-2, "N mm": 1e-3, "kN m": 1e3, "lbf in": _POUND * _GRAVITY * _INCH},
    "m^2/N": {"m^2/N": 1.0, "mm^2/N": 1e-6, "mm^3/(N m)": 1e-9, "mm^3/Nm": 1e-9},
    "N m^2": {"N m^2": 1.0, "N mm^2": 1e-6},
    "kg/m^3": {"kg/m^3": 1.0, "g/cm^3": 1e3},
    "N m/rad": {"N m/rad": 1.0, "N m/deg": 180.0 / pi},
    "N m s/rad": {"N m s/rad": 1.0, "N m s/deg": 180.0 / pi},
    "N/m": {"N/m": 1.0, "N/cm": 1e2, "N/mm": 1e3, "kN/m": 1e3, "kN/mm": 1e6},
    "N s/m": {"N s/m": 1.0, "N s/cm": 1e2, "N s/mm": 1e3, "kN s/m": 1e3},
    "N/s": {"N/s": 1.0, "kN/s": 1e3},
    "m/s": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3},
    "m/s^2": {"m/s^2": 1.0, "mm/s^2": 1e-3},
    "rad/s": {"rad/s": 1.0, "deg/s": pi / 180.0, "rpm": pi / 30.0},
    "rad/s^2": {"rad/s^2": 1.0, "deg/s^2": pi / 180.0},
    "kg m^2": {"kg m^2": 1.0},
    "Hz": {"Hz": 1.0, "1/s": 1.0, "kHz": 1e3},
    "V": {"V": 1.0, "mV": 1e-3, "uV": 1e-6},
    "A": {"A": 1.0, "mA": 1e-3},
}
"""How many SI units one unit is, by the SI unit of each dimension."""

_KNOWN = {unit: (si, factor) for si, units in DIMENSIONS.items() for unit, factor in units.items()}

_PRODUCT = re.compile(r"\s*[·⋅*.]\s*|\s+")
_POWER = re.compile(r"(?<=[a-zA-Z])\^?([23])\b")

_LENGTH_WORDS = {name: name for name in LENGTH} | {
    word[:letters]: name for word, name in _IN_WORDS.items() for letters in range(_SHORTEST, len(word) + 1)
}

_HEADER = re.compile(r"\s*(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?\s*")


def si_unit(unit: str) -> tuple[str, float] | None:
    """SI unit of the same dimension, and how many of it one `unit` is; None for a unit that is not known.

    Spellings count as one: `N m`, `Nm`, `N*m`, `N·m`; `m^2`, `m2`, `m²`; `deg`, `°`; `um`, `µm`. Upper and lower case
    do not, `mN` is not `MN`; but for units of length, which may stand in words too (`length_unit`).
    """
    known = _KNOWN.get(unit) or _SPELLINGS.get(_plain(unit))
    length = length_unit(unit) if known is None else None
    return known if length is None else ("m", LENGTH[length])


def length_unit(word: str) -> str | None:
    """Key of `LENGTH` that a file means by a word, in any case; None for what is no unit of length.

    Abbreviated (`mm`, `MM`, `mm.`), in words of either spelling (`millimeter`, `Millimetres`), or such a word cut short
    to four letters or more (`mill`). Empty is none: a unit is never guessed.
    """
    return _LENGTH_WORDS.get(_plain(word.strip().rstrip(".")).lower())


def _plain(unit: str) -> str:
    """A unit without what only differs in how it is written."""
    text = unicodedata.normalize("NFKC", unit.strip()).replace("°", "deg").replace("μ", "u")
    return _PRODUCT.sub(" ", _POWER.sub(r"^\1", text))


_SPELLINGS = {
    spelling: known
    for unit, known in _KNOWN.items()
    for spelling in (_plain(unit), _plain(unit).replace(" ", ""))  # `Nm`, but not `m N`, which may be meant as mN
}


def split_header(header: str) -> tuple[str, str]:
    """Name and unit of a column header: `"tx [mm]"` gives `("tx", "mm")`.

    The unit is empty when the header has none and is not checked against any table. Text that is not of the form
    `name [unit]` (unbalanced or repeated brackets) comes back whole as the name, without a unit.
    """
    match = _HEADER.fullmatch(header)
    if match is None:
        return header.strip(), ""
    return match["name"], (match["unit"] or "").strip()
