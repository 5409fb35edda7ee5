"""Stiffness that grows with deflection: soft tissue, foam that densifies.

F_el = F_base (1 + a (|u|/D)^p) with D the largest deflection of the calibration trials: a >= 0 is what the secant
stiffness has gained there, p says how late. p = 2 is the cubic spring of Duffing; p = 1 resembles the toe region of
soft tissue.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_law


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude a, shape p."""
    a = Parameter("stiffening.gain", "-", 0.3, 0.0, 10.0)
    p = Parameter("stiffening.exponent", "-", 1.5, 0.25, 8.0)
    law = with_law(
        {"stiffening.gain": a.name, "stiffening.exponent": p.name, "stiffening.reference": system.scale.deflection}
    )
    return (
        Candidate(
            "stiffening",
            "",
            "constitutive",
            (a, p),
            law,
            {a.name: 0.0},
            ({a.name: 1.5, p.name: 3.0}, {a.name: 0.5, p.name: 6.0}),
        ),
    )


STIFFENING = Effect(
    "stiffening",
    "constitutive",
    offer,
    "Fung (1993) Biomechanics: Mechanical Properties of Living Tissues, ch. 7; Duffing (1918)",
    ("stiffening.gain", "stiffening.exponent", "stiffening.reference"),
)
