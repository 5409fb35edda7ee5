"""Much stiffer beyond a limit on one side.

Upper: F += K max(u - u_max, 0); lower: F -= K max(u_min - u, 0). K >= 0; the shape is where the limit is, within the
range of the deflection at the starting values and half of it further (base parameters move that range).
"""

from __future__ import annotations

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_law


def stop(system: System, side: str) -> Candidate:
    """Stop on one side."""
    scale = system.scale
    stroke = scale.high - scale.low
    edge, inwards = (scale.high, -stroke) if side == "upper" else (scale.low, stroke)
    stiff, per = largest_load(system) / scale.deflection, system.law.deflection
    name = f"end_stop.{side}"
    k = Parameter(f"{name}.stiffness", f"{system.law.load}/{per}", 2.0 * stiff, 0.0, 100.0 * stiff)
    low, high = sorted((edge - 0.5 * inwards, edge + 0.75 * inwards))
    limit = Parameter(f"{name}.limit", per, edge + 0.2 * inwards, low, high)
    law = with_law({k.name: k.name, limit.name: limit.name})
    others = tuple({limit.name: edge + share * inwards} for share in (0.05, 0.5))
    return Candidate("end_stop", side, "constitutive", (k, limit), law, {k.name: 0.0}, others)


def offer(system: System) -> tuple[Candidate, ...]:
    """Two candidates, a stop above and one below: amplitude K, shape limit."""
    return tuple(stop(system, side) for side in ("upper", "lower"))


END_STOP = Effect(
    "end_stop",
    "constitutive",
    ("elbow",),
    offer,
    "bilinear stiffness; compensation joint of the elbow exoskeleton at its end stop",
    tuple(f"end_stop.{side}.{number}" for side in ("upper", "lower") for number in ("stiffness", "limit")),
)
