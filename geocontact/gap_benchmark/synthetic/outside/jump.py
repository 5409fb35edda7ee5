"""The stiffness changes at once in the middle of the trial: a strap that gives, a bumper that comes loose."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: share of the stiffness that goes [-]."""
    at = rng.uniform(0.35, 0.65) * scale.duration
    sign = rng.choice([-1.0, 1.0])

    def hooks(share: float) -> Hooks:
        def changed(time: Values, u: Values, _: Values) -> Values:
            factor = 1.0 + sign * share * 0.5 * np.tanh((time - at) / (4.0 * scale.step))
            return np.asarray(factor[:, None] if u.ndim == 2 else factor)

        return Hooks(spring=(changed,))

    return Draw(1e-3, 0.5, hooks, lambda s: f"the stiffness changes by {sign * s:.2%} at {at:.2g} s")


JUMP = InjectionPlan("jump", ALL, "stiffness changes mid trial", "", draw, placed=True)
