"""Two springs in series, one of which bottoms out.

planted:   w = s c F + (1 - s) c F1 tanh(F/F1): soft first, a share s of that later
candidate: w = c F* (F/F*)^p
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: compliance c at small loads [rad/N] or [m/N]."""
    force = scale.force
    share, limit = rng.uniform(0.16, 0.31), rng.uniform(0.2, 0.35) * force
    if scale.system == "elbow":  # where base parameters take most of a linear spring away
        share += 0.39 + 0.3 * (1.0 - scale.departure)
    if scale.system in ("shoulder", "sit_to_stand"):  # likewise
        share = 1.0 - scale.departure * (1.0 - share)

    def hooks(soft: float) -> Hooks:
        def foot(_: Values) -> Values:
            return np.array([soft, share * soft, limit])

        def gives(load: Values) -> Values:
            return np.asarray(share * soft * load + (1.0 - share) * soft * limit * np.tanh(load / limit))

        return Hooks(series=(foot if scale.system == "foot" else gives,))

    most = {"foot": 0.006 / 1400.0, "elbow": 0.5 / force}.get(scale.system, scale.stroke / force)
    unit = "rad/N" if scale.system == "elbow" else "m/N"
    return Draw(1e-4 * most, most, hooks, lambda c: f"a spring in series gives way by {c:.3g} {unit} at first")


SERIES_COMPLIANCE = InjectionPlan(
    "series_compliance",
    ("elbow", "foot", "shoulder", "sit_to_stand"),
    "two springs, one bottoms out",
    "power of load",
    draw,
    placed=True,
    together=True,
)
