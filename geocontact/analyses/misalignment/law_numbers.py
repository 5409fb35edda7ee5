"""Numbers of the elbow's law: their units where people write them, and what they cannot be. Light to import."""

from __future__ import annotations

from collections.abc import Mapping

from geocontact.data.errors import InputError
from geocontact.data.plausible import ByName, ByPlace, Plausible
from geocontact.data.ranges import ATTACHMENT, DAMPING
from geocontact.data.units import Unit, mm
from geocontact.io.text.units import DIMENSIONS

MMHG = DIMENSIONS["Pa"]["mmHg"]
PER_SI = {"k": 1.0, "x": 1e3, "y": 1e3, "l": 1e3, "z": 1e3, "b": 1.0, "s": MMHG, "c": 1e3}
"""How many of the unit written one SI unit is."""
WRITTEN = {"k": "N/m", "x": "mm", "y": "mm", "l": "mm", "z": "mm", "b": "N s/m", "s": "1/mmHg", "c": "mm/N"}
"""Unit in which files, tables and the command line write each number."""
STIFFENING = Plausible("stiffening by the pressure of the cuff", Unit("1/mmHg", "1/Pa", 1.0 / MMHG), (-1.0, 1.0))
YIELDING = Plausible("the compliance of a fixation", Unit("mm/N", "m/N", 1e-3), (0.0, 1e4), (0.0, 20.0))
LINK = Plausible("a link of an exoskeleton", mm, (20.0, 2000.0), (40.0, 800.0))
OFFSET = Plausible("an offset of axes", mm, (-1000.0, 1000.0), (-250.0, 250.0))
ACROSS = Plausible("the distance of the attachment from the limb's line", mm, (-1000.0, 1000.0), (-300.0, 300.0))
STROKE = Plausible("a stroke", mm, (-1000.0, 1000.0), (-200.0, 200.0))
N_M, N_M_PER_RAD = Unit("N m", "N m", 1.0), Unit("N m/rad", "N m/rad", 1.0)
TORQUE = Plausible("the torque of an actuator of an arm", N_M, (-1000.0, 1000.0), (-100.0, 100.0))
TURNING = Plausible("the stiffness of a cuff against turning", N_M_PER_RAD, (0.0, 1e4), (0.0, 500.0))
NUMBERS = ByName(
    (
        ("k", ATTACHMENT),
        ("x", OFFSET),
        ("y", OFFSET),
        ("l", LINK),
        ("z", ACROSS),
        ("b", DAMPING),
        ("s", STIFFENING),
        ("c", YIELDING),
    )
)
"""What the numbers of the law can be."""
MEANS = ByName(tuple((name, ByPlace((known, None))) for name, known in NUMBERS.ranges))
"""The same where a standard deviation follows each."""
TOPS = ByName(tuple((name, ByPlace((None, known))) for name, known in NUMBERS.ranges))
"""The same for upper bounds; a lower one may be 0."""
DRIFT = ByName((("x", ByPlace((OFFSET,))), ("y", ByPlace((OFFSET,)))))
"""What the first coefficients of a drifting axis can be."""


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
