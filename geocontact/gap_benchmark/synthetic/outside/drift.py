"""A sensor that follows the temperature of the room up and down, other in every trial."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: of the drift in the channel's unit."""
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most = scale.output[names[row]]
    turns = rng.uniform(1.5, 3.0)

    def hooks(size: float) -> Hooks:
        def drifting(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            angle = 2.0 * np.pi * turns * course.time / course.duration + course.phase
            out[row] += size * (np.sin(angle) + 0.5 * np.sin(1.7 * angle + 2.0 * course.phase))
            return out

        return Hooks(sensor=((45.0, drifting),))

    return Draw(1e-4 * most, 0.2 * most, hooks, lambda a: f"{names[row]} wanders up and down by {a:.3g}")


WANDER = InjectionPlan("wander", ALL, "up and down, other in every trial", "", draw)
