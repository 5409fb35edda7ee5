"""Numbers of the elbow's law: their units where people write them, and what they cannot be. Light to import."""

from __future__ import annotations

from collections.abc import Mapping

from geocontact.data.errors import InputError
from geocontact.io.text.units import DIMENSIONS

MMHG = DIMENSIONS["Pa"]["mmHg"]
PER_SI = {"k": 1.0, "x": 1e3, "y": 1e3, "l": 1e3, "z": 1e3, "b": 1.0, "s": MMHG}
"""How many of the unit written one SI unit is."""
WRITTEN = {"k": "N/m", "x": "mm", "y": "mm", "l": "mm", "z": "mm", "b": "N s/m", "s": "1/mmHg"}
"""Unit in which files, tables and the command line write each number."""
LINKS = 20e-3, 2.0
"""m; no arm wears a shorter or a longer link."""


def with_units(numbers: Mapping[str, float]) -> dict[str, float]:
    """Numbers in SI as JSON holds them, "l_mm": 169."""
    return {key_of(name): value * PER_SI[name] for name, value in numbers.items()}


def key_of(name: str) -> str:
    """Name and unit as one key: k_N_per_m."""
    return f"{name}_{WRITTEN[name].replace('1/', 'per_').replace('/', '_per_').replace(' ', '_')}"


def require_names(names: Mapping[str, object] | None, option: str) -> None:
    """Refuse numbers that the law does not have."""
    for name in names or {}:
        if name not in PER_SI:
            raise InputError("", option, f"{name!r} is no number of the law", f"these are {', '.join(PER_SI)}")


def require_link(length: float, option: str) -> None:
    """Refuse a link [m] that no arm wears: metres where millimetres are asked for, or the other way round."""
    if 0.0 < length < LINKS[0] or length > LINKS[1]:
        what = f"l = {length * 1e3:g} mm is no link of an exoskeleton"
        raise InputError("", option, what, "are metres taken for millimetres, or millimetres for metres?")
