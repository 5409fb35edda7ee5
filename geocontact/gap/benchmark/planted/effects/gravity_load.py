"""Weight of a body whose centre does not lie on the link.

planted:   W (sin(beta + phi) + e sin(3 beta)): a second mass that swings on its strap, e = 0.04..0.08
candidate: W sin(beta + phi)
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap.benchmark.planted.course import Course
from geocontact.gap.benchmark.planted.hooks import Hooks, Outputs
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: weight W [N], of either sense."""
    sign, phase = rng.choice([-1.0, 1.0]), rng.uniform(-0.15, 0.15)
    hanging = scale.departure * rng.uniform(0.04, 0.08)

    def hooks(weight: float) -> Hooks:
        def hang(course: Course, _: Mapping[str, float]) -> Outputs:
            beta = course.position[0]
            return np.asarray(sign * weight * (np.sin(beta + phase) + hanging * np.sin(3.0 * beta)))[None]

        return Hooks(load=(hang,))

    return Draw(1e-3 * scale.force, 0.5 * scale.force, hooks, lambda w: f"unmodelled weight of {sign * w:.3g} N")


GRAVITY_LOAD = Plan("gravity_load", ("elbow",), "two masses, one swings", "sine of the angle", draw)
