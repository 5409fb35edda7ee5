"""The joint's axis wanders along a smooth path.

planted:   x + a w tanh(phi/w) + c a sin(3 phi), phi = beta - middle, w = 0.6..1.0 rad
candidate: x + a phi + c phi^2
"""

from __future__ import annotations

import numpy as np

from geocontact.gap.benchmark.planted.hooks import Hooks, Values
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: slope a [m/rad] in the middle, of either sign."""
    sign = rng.choice([-1.0, 1.0])
    width = rng.uniform(0.9, 1.3) if scale.departure == 1.0 else 3.0
    ripple = scale.departure * rng.uniform(0.06, 0.1)

    def hooks(slope: float) -> Hooks:
        def wander(angle: Values) -> Values:
            u = (angle - scale.middle) / width
            return np.asarray(sign * slope * (width * np.tanh(u) + ripple * np.sin(3.0 * width * u)))

        return Hooks(axis=(wander,))

    return Draw(1e-5, 0.03, hooks, lambda a: f"x moves by {sign * a:.3g} m per rad")


AXIS_MIGRATION = Plan("axis_migration", ("elbow",), "path that levels off and ripples", "parabola in the angle", draw)
