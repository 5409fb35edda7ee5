"""What is typed of the elbow's law, in SI: k=222,x=48,y=59,l=169,z=127 in N/m and mm."""

from __future__ import annotations

from geocontact.analyses import quantities
from geocontact.analyses.misalignment.law_numbers import MMHG, PER_SI, require_names
from geocontact.data.errors import InputError
from geocontact.io.text.units import ANGLE

EXAMPLE = "l=169,z=127 (N/m, mm, N s/m, 1/mmHg, mm/N)"


def numbers(text: str, option: str) -> dict[str, float]:
    """ "l=169,z=127" to numbers in SI by name."""
    return {name: _in_si(name, value, option) for name, value in _assignments(text, option).items()}


def pairs(text: str, option: str) -> dict[str, tuple[float, float]]:
    """ "x=-60:60" to pairs of numbers in SI by name."""
    found = {}
    for name, value in _assignments(text, option).items():
        first, last = _ends(value, option)
        found[name] = _in_si(name, first, option), _in_si(name, last, option)
    return found


def names(text: str, option: str) -> tuple[str, ...]:
    """ "b,s" to names."""
    return tuple(name.strip() for name in text.split(","))


def pair(text: str, option: str) -> tuple[float, float]:
    """ "0.05:0.35" to two numbers."""
    first, last = (quantities.number(end, option, "5:95") for end in _ends(text, option))
    return first, last


def degrees(text: str, option: str) -> tuple[float, float]:
    """ "8:92" in degrees to two angles [rad]."""
    first, last = pair(text, option)
    return first * ANGLE["deg"], last * ANGLE["deg"]


def mercury(text: str, option: str) -> tuple[float, float]:
    """ "10:60" in mmHg to two pressures [Pa]."""
    first, last = pair(text, option)
    return first * MMHG, last * MMHG


def _assignments(text: str, option: str) -> dict[str, str]:
    """ "l=169,z=120:6" to what is written for each name."""
    found: dict[str, str] = {}
    for part in text.split(","):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals or not value:
            raise InputError("", option, f"{part.strip()!r} is not name=value", f"write for example {EXAMPLE}")
        if name in found:
            raise InputError("", option, f"{name} is given twice", "give each once")
        found[name] = value
    require_names(found, option)
    return found


def _in_si(name: str, text: str, option: str) -> float:
    return quantities.number(text, option, EXAMPLE) / PER_SI[name]


def _ends(text: str, option: str) -> tuple[str, str]:
    first, colon, last = text.partition(":")
    if not colon:
        raise InputError("", option, f"{text!r} is not a pair of numbers", "write them with a colon, as in 5:95")
    return first, last
