"""Options that only analyses of the shoulder have: support levels, shares, quantities. Light to import."""

from __future__ import annotations

from typing import Annotated

from geocontact.analyses.frame import quantities
from geocontact.analyses.frame.marks import Spelled, Typed
from geocontact.data.errors import InputError
from geocontact.data.plausible import KG, PLAIN, N, Plausible
from geocontact.data.units import Unit, m, percent
from geocontact.io.text.units import ANGLE

EXAMPLE = "100%"
CURRENT = Plausible("the current of a tool", Unit("A", "A", 1.0), (0.0, 1000.0), (0.0, 100.0))
HEIGHT = Plausible("the height of a person", m, (0.5, 2.8), (0.8, 2.2))
HAND_TOOL = Plausible("the mass of a hand tool", KG, (0.0, 50.0), (0.05, 20.0), or_zero=True)
PUSH = Plausible("the push on a tool", N, (0.0, 5000.0), (1.0, 500.0), or_zero=True)
ANKLES = Plausible("the stiffness of ankles over m g h", PLAIN, (0.0, 100.0), (1.0, 5.0))
TORQUE_RATE = Plausible("a rate of torque in N m/s", PLAIN, (1e-3, 1e5), (1.0, 1000.0))


def level(text: str, option: str) -> float:
    """ "100%" or "0.5" to a share; 0 is no support."""
    value = quantities.number(text.strip().rstrip("% "), option, EXAMPLE)
    if "%" not in text and value > 1.0:
        raise InputError("", option, f"{text!r} may be meant in per cent", f"write {text}% or {0.01 * value:g}")
    return value * (0.01 if "%" in text else 1.0)


def elevations(text: str, option: str) -> tuple[float, ...]:
    """ "39,129" to angles [rad], degrees unless a unit is written."""
    return tuple(_angle(part.strip(), option) for part in text.split(","))


def _angle(text: str, option: str) -> float:
    unit = next((unit for unit in ANGLE if text.endswith(unit)), "")
    return quantities.number(text.removesuffix(unit), option, "39,129") * ANGLE[unit or "deg"]


def require_share(value: float, option: str, example: str) -> None:
    """Refuse what is below 0 or above 1."""
    if not 0.0 <= value <= 1.0:
        meant = f"is {value:g} % meant?" if 1.0 < value <= 100.0 else f"give for example {example}"
        raise InputError("", f"`{option}`", f"{100.0 * value:g} % is not 0 to 100 %", meant)


Share = Annotated[float, Typed("-", "shoulder.shared_options:level", "0.5")]
SUPPORT = Plausible("a level of support", percent, (0.0, 100.0), (5.0, 100.0), or_zero=True)
Level = Annotated[
    float, Typed("-", "shoulder.shared_options:level", "0.5"), Spelled(default=EXAMPLE, dashed=True), SUPPORT
]
