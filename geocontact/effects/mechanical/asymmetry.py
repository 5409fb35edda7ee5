"""Loading and unloading differ in stiffness; at the knee the medial and the lateral side do.

k → k (1 + a tanh(δ'/v)): stiffer by a while loaded, softer by a while let go, with |u|' for δ' where the law pulls as
well as pushes; a >= 0, because the opposite would make energy. The shape v is the rate over which the one becomes the
other, so that the force does not jump at the turn.
Knee: medial 1 + d times as stiff as the mean, lateral 1 - d times, d of either sign and at most 0.5 (one side
three times as stiff as the other), the same throughout: no shape.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_geometry, with_law

SIDES = "asymmetry.sides"


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: the sides where a system has two, else the directions."""
    return (between_sides() if system.geometry.slots.free(SIDES) else between_directions(system),)


def between_sides() -> Candidate:
    """Amplitude d."""
    d = Parameter("asymmetry.difference", "-", 0.05, -0.5, 0.5)
    return Candidate(
        "asymmetry", "", "constitutive", (d,), with_geometry({SIDES: d.name}), {d.name: 0.0}, ({d.name: -0.05},)
    )


def between_directions(system: System) -> Candidate:
    """Amplitude a, shape v."""
    rate = system.scale.rate
    a = Parameter("asymmetry.excess", "-", 0.1, 0.0, 0.9)
    v = Parameter("asymmetry.turning", f"{system.law.deflection}/s", 0.1 * rate, 1e-3 * rate, 0.5 * rate)
    law = with_law({"asymmetry.excess": a.name, "asymmetry.turning": v.name})
    return Candidate("asymmetry", "", "constitutive", (a, v), law, {a.name: 0.0}, ({v.name: 0.3 * rate},))


ASYMMETRY = Effect(
    "asymmetry",
    "constitutive",
    offer,
    "loading and unloading stiffness of Walton & Braun (1986) J. Rheol. 30:949, made rate-smooth",
    ("asymmetry.excess", "asymmetry.turning"),
)
