"""A zero error that drifts slowly.

planted:   y + o (1 + e sin(2 pi m t/T + phi)), e = 0.16..0.3 (straps 0.05..0.08), m = 1..2.5
candidate: y + o
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes

WANDER = {"sit_to_stand": (0.05, 0.08)}
"""Range of e where base parameters take most of a plain offset away."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: offset o in the channel's unit, of either sign."""
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most = scale.output[names[row]]
    sign, drift = rng.choice([-1.0, 1.0]), scale.departure * rng.uniform(*WANDER.get(scale.system, (0.16, 0.3)))
    turns, phase = rng.uniform(1.0, 2.5), rng.uniform(0.0, 2.0 * np.pi)

    def hooks(offset: float) -> Hooks:
        def shifted(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            slow = np.sin(2.0 * np.pi * turns * course.time / course.duration + phase)
            out[row] += sign * offset * (1.0 + drift * slow)
            return out

        return Hooks(sensor=((40.0, shifted),))

    top = {"elbow": 0.4, "sit_to_stand": 0.4}.get(scale.system, 0.15)
    return Draw(1e-4 * most, top * most, hooks, lambda o: f"{names[row]} reads {sign * o:.3g} too much", names[row])


SENSOR_OFFSET = InjectionPlan(
    "sensor_offset",
    ALL,
    "offset that wanders",
    "constant offset",
    draw,
)
