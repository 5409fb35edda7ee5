"""A damper that thins with rate and grips harder as it is pressed.

planted:   b v / (1 + |v|/v1) (1 + s u/D); foot: per sphere b d' (1 - exp(-(d/d1)^2)) / (1 + |d'|/v1)
           (1 + e d'/hypot(d', V)), e = 0.18..0.28: held harder while pressed
candidate: b v |v/V|^(q - 1); foot: b d' s(d/d_full) (d/D)^q, or b d' |d'/V|^(p - 1) s(d/d_full) (d/D)^n
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

THINNING = {"elbow": (4.0, 8.0), "foot": (1.2, 2.5), "shoulder": (1.5, 3.0), "sit_to_stand": (2.5, 4.5)}
"""Range of v1 in units of the rms rate."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: b at small rates [N s/m]."""
    thinning = (rng.uniform(*THINNING[scale.system])) * scale.rate
    if scale.system == "shoulder":  # where base parameters take a plain damper away
        thinning /= scale.departure
    lean = rng.uniform(0.45, 0.65) * (1.5 if scale.system == "sit_to_stand" else scale.departure)
    reach = rng.uniform(0.25, 0.5) * scale.stroke
    harder = rng.uniform(0.18, 0.28) if scale.system == "foot" else 0.0

    def hooks(b: float) -> Hooks:
        def strap(p: Pull) -> Values:
            return np.asarray(
                b * p.rate / (1.0 + np.abs(p.rate) / thinning) * (1.0 + lean * p.deflection / scale.stroke)
            )

        def foot(p: Pull) -> Values:
            inside = np.maximum(p.deflection, 0.0) / reach
            way = p.rate / np.hypot(p.rate, scale.rate)
            drag = b * p.rate * -np.expm1(-inside * inside) / (1.0 + np.abs(p.rate) / thinning)
            return np.asarray(drag * (1.0 + harder * way))

        return Hooks(beside=(foot if scale.system == "foot" else strap,))

    most = 3000.0 if scale.system == "foot" else 0.5 * scale.force / scale.rate
    return Draw(1e-4 * most, most, hooks, lambda b: f"viscous damping of {b:.3g} N s/m that thins with rate")


DAMPING = InjectionPlan(
    "damping",
    ("elbow", "foot", "shoulder", "sit_to_stand"),
    "rate-thinning, deflection-dependent, uneven",
    "power of rate or depth",
    draw,
    placed=True,
    together=True,
)
