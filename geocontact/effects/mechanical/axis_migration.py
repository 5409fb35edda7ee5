"""A length of the joint changes with its angle: x of the elbow, o_x of the shoulder; R of the knee; ρ of a site.

x → x + a φ + c φ², φ = β - the middle of the measured range, so that x keeps its meaning there; at the shoulder φ is
the arm's angle itself, because o_x is known from the arm that hangs down. a of either sign, a few centimetres per
radian; the curvature c is the shape. Its rate moves the deflection as well. The lever ρ of a strapped-on site changes
with the site's own rotation, which is small: by the largest lever that is allowed over half its range at most.
"""

from __future__ import annotations

import math

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_geometry

BEND = 0.6
"""Largest curvature per radian, over the largest migration."""


def longest_lever(system: System) -> float:
    """Longest lever of a site [m]: as far as an attachment reaches."""
    ends = [abs(each) for p in system.parameters if p.unit == "m" for each in (p.start, p.lower, p.upper)]
    return max((each for each in ends if math.isfinite(each)), default=0.0) or system.length


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude a, shape c."""
    angle = next((name for name in system.inputs if system.unit(name) == "rad"), system.geometry.yields)
    migration = system.traits.migration
    most = migration.most * system.length
    bend = BEND * most
    if system.role(angle) == "turn":
        half, lever = system.scale.span.get(angle, 1.0), longest_lever(system)
        most, bend = lever / half, lever / half**2
    a = Parameter("axis_migration.slope", "m/rad", 0.1 * most, -most, most)
    c = Parameter("axis_migration.curvature", "m/rad^2", 0.0, -bend, bend)
    centre = system.scale.centre.get(angle, 0.0) if migration.centre is None else migration.centre
    link = with_geometry({a.name: a.name, c.name: c.name, "axis_migration.centre": centre})
    neutral = {a.name: 0.0, c.name: 0.0}
    return (Candidate("axis_migration", "", "geometry", (a, c), link, neutral, ({a.name: -a.start},)),)


AXIS_MIGRATION = Effect(
    "axis_migration",
    "geometry",
    offer,
    "instantaneous axis of the elbow: Bottlang et al. (2000) J. Orthop. Res. 18:821; R(φ) of a knee: `geocontact fit`",
    ("axis_migration.slope", "axis_migration.curvature", "axis_migration.centre"),
)
