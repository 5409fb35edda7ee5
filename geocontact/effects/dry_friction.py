"""Coulomb-like force against the motion, with a pre-sliding range.

"stroke": F += F_c z, dz/du = (sign(u') - z)/reach (Dahl): a stroke much longer than `reach` feels ±F_c, a reversal is
spread over `reach` and comes late. A trial starts with unloaded friction. Exact between reversals, whatever the
sampling. "rate": F += F_c tanh(u'/v): a reversal is spread over the rates within ±v, before the turn as after it, as
the friction tables of contact libraries have it. u is the deflection itself, F_c >= 0.
"""

from __future__ import annotations

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_law


def over_a_stroke(system: System) -> Candidate:
    """Amplitude F_c, shape reach."""
    stroke = system.scale.high - system.scale.low
    unit = system.law.deflection
    reach = Parameter("dry_friction.stroke.reach", unit, 0.02 * stroke, 1e-4 * stroke, 0.2 * stroke)
    return rubbing(system, "stroke", reach, 0.1 * stroke)


def over_rates(system: System) -> Candidate:
    """Amplitude F_c, shape v."""
    rate = system.scale.rate
    unit = f"{system.law.deflection}/s"
    turning = Parameter("dry_friction.rate.turning", unit, 0.1 * rate, 1e-3 * rate, 0.5 * rate)
    return rubbing(system, "rate", turning, 0.3 * rate)


def rubbing(system: System, variant: str, shape: Parameter, other: float) -> Candidate:
    """Friction whose limit is the amplitude."""
    most = largest_load(system)
    limit = Parameter(f"dry_friction.{variant}.limit", system.law.load, 0.1 * most, 0.0, most)
    law = with_law({limit.name: limit.name, shape.name: shape.name})
    neutral, others = {limit.name: 0.0}, ({shape.name: other},)
    return Candidate("dry_friction", variant, "constitutive", (limit, shape), law, neutral, others)


def offer(system: System) -> tuple[Candidate, ...]:
    """Two candidates, regularised by displacement and by rate."""
    return over_a_stroke(system), over_rates(system)


DRY_FRICTION = Effect(
    "dry_friction",
    "constitutive",
    ("elbow", "sit_to_stand"),
    offer,
    "Dahl (1968) Aerospace Corp. TOR-0158(3107-18)-1; Olsson et al. (1998) Eur. J. Control 4:176",
    ("dry_friction.stroke.limit", "dry_friction.stroke.reach", "dry_friction.rate.limit", "dry_friction.rate.turning"),
)
