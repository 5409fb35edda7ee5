"""What is typed of free coordinates and springs, in SI."""

from __future__ import annotations

from geocontact.analyses import quantities
from geocontact.data.errors import InputError
from geocontact.io.text.units import ANGLE

EXAMPLE = "anterior=30,rotation=0.36 (N/mm, N m/deg)"
PER_MM = ("anterior", "axial", "mediolateral")


def names(text: str, option: str) -> tuple[str, ...]:
    """ "adduction,rotation" to names; "none" to nothing."""
    return () if text.strip() == "none" else tuple(name.strip() for name in text.split(","))


def springs(text: str, option: str) -> dict[str, float]:
    """ "anterior=30,rotation=0.36" in N/mm and N m/deg to N/m and N m/rad by name."""
    found: dict[str, float] = {}
    for part in text.split(","):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals:
            raise InputError("", option, f"{part.strip()!r} is not name=value", f"write for example {EXAMPLE}")
        if name in found:
            raise InputError("", option, f"{name} is given twice", "give each once")
        number = quantities.number(value, option, EXAMPLE)
        found[name] = number * 1e3 if name in PER_MM else number / ANGLE["deg"]
    return found
