"""Viscous force against the rate of the deflection, where the base has none or too little.

Elbow: F += b v |v/V|^(q - 1), with V the rms rate of the calibration trials, so that b is the damping at that rate
whatever the shape q; q = 1 is the dashpot of Kelvin and Voigt. Foot, per sphere: F += b δ' s(δ/δ_full) (δ/D)^q while
loading and unloading, never pulling; q = 0 is a dashpot, q = n the damping of Hunt and Crossley. That damping may thin
with rate instead, as rubber and tissue do ("thinning"): F += b δ' |δ'/V|^(p - 1) s(δ/δ_full) (δ/D)^n. b >= 0: it only
dissipates.
"""

from __future__ import annotations

from dataclasses import replace

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Source
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_law


def offer(system: System) -> tuple[Candidate, ...]:
    """Amplitude b, shape q; at a foot also the shape p instead of q."""
    scale = system.scale
    strong = largest_load(system) / scale.rate
    presses = "delta_full" in system.law.slots.neutral
    b = Parameter("damping.b", f"{system.law.load} s/{system.law.deflection}", 0.02 * strong, 0.0, strong)
    start, least, reference = (0.5, 0.0, scale.deflection) if presses else (1.0, 0.5, scale.rate)
    q = Parameter("damping.exponent", "-", start, least, 2.0)
    law = with_law({"damping.b": b.name, "damping.exponent": q.name, "damping.reference": reference})
    made = Candidate("damping", "", "constitutive", (b, q), law, {b.name: 0.0}, ({b.name: 0.3 * strong},))
    if not presses:
        return (made,)
    p = Parameter("damping.power", "-", 0.8, 0.4, 1.0)
    numbers: dict[str, Source] = {"damping.b": b.name, "damping.power": p.name, "damping.rate": scale.rate}
    numbers |= {"damping.exponent": "n", "damping.reference": reference}
    thinning = with_law(numbers)
    return (made, replace(made, variant="thinning", parameters=(b, p), link=thinning, starts=({b.name: 0.3 * strong},)))


DAMPING = Effect(
    "damping",
    "constitutive",
    offer,
    "Hunt & Crossley (1975) J. Appl. Mech. 42:440; Flores & Lankarani (2016), Contact Force Models",
    ("damping.b", "damping.exponent", "damping.reference"),
)
