"""Loading and unloading differ in stiffness.

k → k (1 + a tanh(δ'/v)): stiffer by a while loaded, softer by a while let go, with |u|' for δ' where the law pulls as
well as pushes; a >= 0, because the opposite would make energy. The shape v is the rate over which the one becomes the
other, so that the force does not jump at the turn.
"""

from __future__ import annotations

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_law


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude a, shape v."""
    rate = system.scale.rate
    a = Parameter("asymmetry.excess", "-", 0.1, 0.0, 0.9)
    v = Parameter("asymmetry.turning", f"{system.law.deflection}/s", 0.1 * rate, 1e-3 * rate, 0.5 * rate)
    law = with_law({"asymmetry.excess": a.name, "asymmetry.turning": v.name})
    return (Candidate("asymmetry", "", "constitutive", (a, v), law, {a.name: 0.0}, ({v.name: 0.3 * rate},)),)


ASYMMETRY = Effect(
    "asymmetry",
    "constitutive",
    ("foot",),
    offer,
    "loading and unloading stiffness of Walton & Braun (1986) J. Rheol. 30:949, made rate-smooth",
    ("asymmetry.excess", "asymmetry.turning"),
)
