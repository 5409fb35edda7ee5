"""Units as makers of mats write them: `KPa`, `PSI`, `kg/cm²`, `centimeters`, `sq. in`."""

from __future__ import annotations

import re
import unicodedata

from geocontact.io.text import units
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
