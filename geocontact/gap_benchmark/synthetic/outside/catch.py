"""A hinge whose bearing catches: it is drawn to one angle from either side, as by a dent."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

LEVER = 0.25
"""Between the hinge and where it is loaded [m]."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: torque over the lever [N] at either flank of the dent."""
    angle, wide = scale.middle + scale.span * rng.uniform(-0.5, 0.5), rng.uniform(0.06, 0.15)

    def hooks(size: float) -> Hooks:
        def caught(p: Swing) -> Values:
            x = (p.angle - angle) / wide
            return np.asarray(size * LEVER * x * np.exp(0.5 - 0.5 * x * x))

        return Hooks(hinge=(caught,))

    words = f"the hinge catches at {angle:.2g} rad, by"
    return Draw(1e-3 * scale.force, 0.6 * scale.force, hooks, lambda a: f"{words} {a * LEVER:.3g} N m")


CATCH = InjectionPlan("catch", ("shoulder",), "hinge drawn to an angle", "", draw)
