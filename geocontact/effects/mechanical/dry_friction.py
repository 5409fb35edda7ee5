"""Coulomb-like force against the motion, with a pre-sliding range.

"stroke": F += F_c z, dz/du = (sign(u') - z)/reach (Dahl): a stroke much longer than `reach` feels ±F_c, a reversal is
spread over `reach` and comes late. A trial starts with unloaded friction. Exact between reversals, whatever the
sampling. "rate": F += F_c tanh(u'/v): a reversal is spread over the rates within ±v, before the turn as after it, as
the friction tables of contact libraries have it. u is the deflection itself, F_c >= 0. Shoulder: both are torques
at the exoskeleton's hinge, T_c z and T_c tanh(e'/v), u being its angle e.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Source
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_geometry, with_law

HELD = 4e-3, 2e-2
"""Over the range of the recorded arm and over its rate: where friction at the hinge begins to follow noise."""


@dataclass(frozen=True)
class Rubbing:
    """What rubs: its largest friction, its stroke and rate, their units, and the link that the numbers belong to.

    `finest` are the shortest reach over the stroke and the slowest turning over the rate.
    """

    most: float
    stroke: float
    rate: float
    load: str
    way: str
    replaced: Callable[[Mapping[str, Source]], Callable[[System], System]]
    finest: tuple[float, float] = (1e-4, 1e-3)


def at_the_interface(system: System) -> Rubbing:
    """The deflection."""
    scale, law = system.scale, system.law
    return Rubbing(largest_load(system), scale.high - scale.low, scale.rate, law.load, law.deflection, with_law)


def at_the_hinge(system: System) -> Rubbing:
    """The exoskeleton's arm, which turns about as far and as fast as the recorded one.

    Friction that holds the arm within less than the noise of the recording (0.2 % of its range, and that a few times a
    second) would be wanted for smoothing that noise alone.
    """
    scale, arm = system.scale, system.geometry.yields
    lever = {**system.known, **system.start}["L_h"]
    turn, rate = 2.0 * scale.span.get(arm, 1.0), scale.speed.get(arm, 1.0)
    return Rubbing(largest_load(system) * lever, turn, rate, "N m", "rad", with_geometry, HELD)


def over_a_stroke(what: Rubbing) -> Candidate:
    """Amplitude F_c, shape reach."""
    stroke = what.stroke
    reach = Parameter("dry_friction.stroke.reach", what.way, 0.02 * stroke, what.finest[0] * stroke, 0.2 * stroke)
    return rubbing(what, "stroke", reach, 0.1 * stroke)


def over_rates(what: Rubbing) -> Candidate:
    """Amplitude F_c, shape v."""
    rate = what.rate
    turning = Parameter("dry_friction.rate.turning", f"{what.way}/s", 0.1 * rate, what.finest[1] * rate, 0.5 * rate)
    return rubbing(what, "rate", turning, 0.3 * rate)


def rubbing(what: Rubbing, variant: str, shape: Parameter, other: float) -> Candidate:
    """Friction whose limit is the amplitude."""
    limit = Parameter(f"dry_friction.{variant}.limit", what.load, 0.1 * what.most, 0.0, what.most)
    link = what.replaced({limit.name: limit.name, shape.name: shape.name})
    neutral, others = {limit.name: 0.0}, ({shape.name: other},)
    return Candidate("dry_friction", variant, "constitutive", (limit, shape), link, neutral, others)


def offer(system: System) -> tuple[Candidate, ...]:
    """Two candidates, regularised by displacement and by rate."""
    hinged = system.geometry.slots.free("dry_friction.stroke.limit")
    what = at_the_hinge(system) if hinged else at_the_interface(system)
    return over_a_stroke(what), over_rates(what)


DRY_FRICTION = Effect(
    "dry_friction",
    "constitutive",
    offer,
    "Dahl (1968) Aerospace Corp. TOR-0158(3107-18)-1; Olsson et al. (1998) Eur. J. Control 4:176",
    ("dry_friction.stroke.limit", "dry_friction.stroke.reach", "dry_friction.rate.limit", "dry_friction.rate.turning"),
)
