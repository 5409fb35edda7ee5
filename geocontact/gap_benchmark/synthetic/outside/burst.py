"""Somebody or something else pushes for a part of the trial."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: push [N], at the same part of every trial."""
    row = scale.load(rng)
    at, wide = rng.uniform(0.25, 0.75), rng.uniform(0.03, 0.09)
    sign = rng.choice([-1.0, 1.0])

    def hooks(size: float) -> Hooks:
        def push(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            out[row] += sign * size * np.exp(-(((course.time / course.duration - at) / wide) ** 4))
            return out

        return Hooks(sensor=((5.0, push),))

    return Draw(1e-4 * scale.force, 0.5 * scale.force, hooks, lambda a: f"a push of {sign * a:.3g} N around {at:.0%}")


BURST = InjectionPlan("burst", ALL, "push in a part of the trial", "", draw)
