"""Numbers of the elbow's law as they are typed: k=222,x=48,y=59,l=169,z=127 in N/m and mm."""

from __future__ import annotations

from geocontact.analyses import quantities
from geocontact.data.errors import InputError
from geocontact.io.text.units import DIMENSIONS

MMHG = DIMENSIONS["Pa"]["mmHg"]
PER_SI = {"k": 1.0, "x": 1e3, "y": 1e3, "l": 1e3, "z": 1e3, "b": 1.0, "s": MMHG}
"""How many of the unit typed one SI unit is."""
TYPED = {"k": "N/m", "x": "mm", "y": "mm", "l": "mm", "z": "mm", "b": "N s/m", "s": "1/mmHg"}
EXAMPLE = "l=169,z=127 (N/m, mm, N s/m, 1/mmHg)"

SHORTEST_LINK = 20e-3  # m


def require_link(length: float, option: str) -> None:
    """Refuse a link [m] that no arm wears: metres typed where mm are asked for."""
    if 0.0 < length < SHORTEST_LINK:
        what = f"l = {length * 1e3:g} mm is no link of an exoskeleton: are these metres?"
        raise InputError("", option, what, f"give mm, such as {EXAMPLE.split(',', maxsplit=1)[0]}")


def assignments(text: str | None, option: str) -> dict[str, str]:
    """ "l=169,z=120:6" to what is written for each name."""
    found: dict[str, str] = {}
    for part in text.split(",") if text else ():
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if name not in PER_SI or not equals or not value:
            what = f"{part.strip()!r} is not name=value with one of {', '.join(PER_SI)}"
            raise InputError("", option, what, f"write for example {EXAMPLE}")
        if name in found:
            raise InputError("", option, f"{name} is given twice", "give each once")
        found[name] = value
    return found


def values(text: str | None, option: str) -> dict[str, float]:
    """Numbers in SI units by name."""
    return {name: quantities.number(value, option, EXAMPLE) / PER_SI[name]
            for name, value in assignments(text, option).items()}  # fmt: skip


def pairs(text: str | None, option: str) -> dict[str, tuple[float, float]]:
    """Pairs of numbers in SI units by name, "x=-60:60"."""
    return {name: tuple(end / PER_SI[name] for end in pair(value, option))  # type: ignore[misc]
            for name, value in assignments(text, option).items()}  # fmt: skip


def pair(text: str, option: str) -> tuple[float, float]:
    """ "-60:60" to two numbers."""
    first, colon, last = text.partition(":")
    if not colon:
        raise InputError("", option, f"{text!r} is not a pair of numbers", "write them with a colon, as in 5:95")
    return quantities.number(first, option, "5:95"), quantities.number(last, option, "5:95")


def interval(text: str, option: str) -> tuple[float, float]:
    """The same, the first below the second."""
    low, high = pair(text, option)
    if not low < high:
        raise InputError("", option, f"{text!r} has no room between its ends", "write lower:upper")
    return low, high


def unit_in_key(name: str) -> str:
    """Unit of a number as part of a key: N_per_m."""
    return TYPED[name].replace("1/", "per_").replace("/", "_per_").replace(" ", "_")
