"""Names of the quantities that a stance is compared with its plate in, and what an R² below 0 of one says."""

from __future__ import annotations

NAMES = {
    "resultant": "resultant force",
    "vertical": "vertical force",
    "fore_aft": "fore-aft force",
    "medio_lateral": "sideways force",
    "impulse": "impulse",
    "cop_ground": "centre of pressure",
    "cop_sphere": "centre of pressure, middle of the spheres",
    "ankle_moment": "ankle moment",
    "stance": "length of the stance",
}
"""Quantities in words."""
SAID = ("resultant", "cop_ground", "ankle_moment")
"""Those that sentences are about."""


SMALL = ("medio_lateral",)
"""Those that are small beside the others: their R² compares an error with little."""


def small_force(quantity: str, r2: float) -> str:
    """How to read an R² below 0 of a small force; empty for others."""
    if quantity not in SMALL or not r2 < 0.0:
        return ""
    return f"{NAMES[quantity]}: R² is {r2:.2f}; this force is small: judge by its error"


ASKED = "are mass, setting, and unit, sign and clock of both plates right?"
"""What an R² below 0 of those that sentences are about asks."""
