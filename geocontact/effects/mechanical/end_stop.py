"""Much stiffer beyond a limit on one side.

Upper: F += K max(u - u_max, 0); lower: F -= K max(u_min - u, 0). Through a buffer, rounded as they are, the force grows
with the power 3/2 of what is beyond the limit, as in Hertz's contact of two spheres: F += K D (max(u - u_max, 0)/D)^1.5
with D the largest deflection. K >= 0; the shape is where the limit is, within the range of the deflection at the
starting values and half of it further (base parameters move that range).
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Source
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_law

BUFFERED = 1.5
"""Power of a buffer's force."""


def stop(system: System, side: str, power: float) -> Candidate:
    """Stop on one side."""
    scale = system.scale
    stroke = scale.high - scale.low
    edge, inwards = (scale.high, -stroke) if side == "upper" else (scale.low, stroke)
    stiff, per = largest_load(system) / scale.deflection, system.law.deflection
    name = f"end_stop.{side}"
    k = Parameter(f"{name}.stiffness", f"{system.law.load}/{per}", 2.0 * stiff, 0.0, 100.0 * stiff)
    low, high = sorted((edge - 0.5 * inwards, edge + 0.75 * inwards))
    limit = Parameter(f"{name}.limit", per, edge + 0.2 * inwards, low, high)
    numbers: dict[str, Source] = {k.name: k.name, limit.name: limit.name}
    if power != 1.0:
        numbers |= {"end_stop.power": power, "end_stop.reference": scale.deflection}
    law = with_law(numbers)
    others = tuple({limit.name: edge + share * inwards} for share in (0.05, 0.5))
    variant = side if power == 1.0 else f"{side}.buffer"
    return Candidate("end_stop", variant, "constitutive", (k, limit), law, {k.name: 0.0}, others, settles=True)


def offer(system: System) -> tuple[Candidate, ...]:
    """A stop above and one below, hard and through a buffer: amplitude K, shape limit."""
    return tuple(stop(system, side, power) for power in (1.0, BUFFERED) for side in ("upper", "lower"))


END_STOP = Effect(
    "end_stop",
    "constitutive",
    offer,
    "bilinear stiffness; compensation joint of the elbow exoskeleton at its end stop",
    (
        *(f"end_stop.{side}.{number}" for side in ("upper", "lower") for number in ("stiffness", "limit")),
        "end_stop.power",
        "end_stop.reference",
    ),
    together=False,
)
