"""Numbers of the elbow's law: units that people write, what they cannot be, how they are typed. Light to import."""

from __future__ import annotations

from collections.abc import Mapping

from geocontact.analyses.frame import quantities
from geocontact.data.errors import InputError
from geocontact.data.plausible import ATTACHMENT, DAMPING, ByName, ByPlace, Plausible
from geocontact.data.units import Unit, deg, mm
from geocontact.io.text.units import ANGLE, DIMENSIONS

EXAMPLE = "l=169,z=127 (N/m, mm, N s/m, 1/mmHg, mm/N)"
MMHG = DIMENSIONS["Pa"]["mmHg"]
PER_SI = {"k": 1.0, "x": 1e3, "y": 1e3, "l": 1e3, "z": 1e3, "b": 1.0, "s": MMHG, "c": 1e3}
"""How many of the unit written one SI unit is."""
WRITTEN = {"k": "N/m", "x": "mm", "y": "mm", "l": "mm", "z": "mm", "b": "N s/m", "s": "1/mmHg", "c": "mm/N"}
"""Unit in which files, tables and the command line write each number."""
STIFFENING = Plausible("stiffening by the pressure of the cuff", Unit("1/mmHg", "1/Pa", 1.0 / MMHG), (-1.0, 1.0))
YIELDING = Plausible("the compliance of a fixation", Unit("mm/N", "m/N", 1e-3), (0.0, 1e4), (0.0, 20.0))
LINK = Plausible("a link of an exoskeleton", mm, (20.0, 2000.0), (40.0, 800.0))
OFFSET = Plausible("an offset of axes", mm, (-1000.0, 1000.0), (-250.0, 250.0), least=0.2)
ACROSS = Plausible(
    "the distance of the attachment from the limb's line", mm, (-1000.0, 1000.0), (-300.0, 300.0), least=15.0
)
"""Skin is 20 mm or more from the line of a limb."""
STROKE = Plausible("a stroke", mm, (-1000.0, 1000.0), (-200.0, 200.0), least=1.0)
N_M, N_M_PER_RAD = Unit("N m", "N m", 1.0), Unit("N m/rad", "N m/rad", 1.0)
TORQUE = Plausible("the torque of an actuator of an arm", N_M, (-1000.0, 1000.0), (-100.0, 100.0))
TURNING = Plausible("the stiffness of a cuff against turning", N_M_PER_RAD, (0.0, 1e4), (0.0, 500.0))
MOMENT_NOISE = Plausible("the noise of a moment", N_M, (0.0, 100.0), (0.0, 5.0))
ANGLE_NOISE = Plausible("the noise of an angle", deg, (0.0, 45.0), (0.0, 10.0))
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
            raise InputError("", option, f"{name!r} is not a number of the law", f"these are {', '.join(PER_SI)}")


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
