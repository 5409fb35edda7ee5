"""A Maxwell branch in parallel: viscoelastic tissue, foam, polyethylene.

F += q, q' = g F_el' - q/tau: the branch starts at g times the elastic force and forgets with the time constant tau, so
slow motion sees F_el and fast motion (1 + g) F_el (quasi-linear viscoelasticity with one exponential). g >= 0. A trial
starts relaxed. Exact over each sample for an elastic force linear in time.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_law

DASHPOT = 0.03  # of the time that a stroke takes at the rms rate: a branch that forgets sooner is a dashpot


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude g, shape tau."""
    scale = system.scale
    swing = (scale.high - scale.low) / max(scale.rate, 1e-300)
    g = Parameter("relaxation.ratio", "-", 0.2, 0.0, 5.0)
    quick, slow = min(max(0.5 * scale.step, DASHPOT * swing), scale.duration), 2.0 * scale.duration
    tau = Parameter("relaxation.tau", "s", quick ** (2 / 3) * slow ** (1 / 3), quick, slow)
    law = with_law({"relaxation.ratio": g.name, "relaxation.tau": tau.name})
    other = {tau.name: quick ** (1 / 3) * slow ** (2 / 3)}
    return (Candidate("relaxation", "", "constitutive", (g, tau), law, {g.name: 0.0}, (other,)),)


RELAXATION = Effect(
    "relaxation",
    "constitutive",
    offer,
    "Maxwell (1867); Fung (1993), sec. 7.6 (quasi-linear viscoelasticity)",
    ("relaxation.ratio", "relaxation.tau"),
)
