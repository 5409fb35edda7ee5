"""Warm-up that is neither linear nor exponential.

planted:   a ((t/T)^p + e sin(2 pi m t/T + phi)), p = 0.7..1.3, e = 0.07..0.11
candidate: r T (1 - exp(-c t/T))/c
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: drift at the end of a trial in the channel's unit, of either sign."""
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most = scale.output[names[row]]
    sign, p, drift = rng.choice([-1.0, 1.0]), rng.uniform(0.7, 1.3), rng.uniform(0.07, 0.11)
    turns, phase = rng.uniform(1.5, 2.5), rng.uniform(0.0, 2.0 * np.pi)

    def hooks(size: float) -> Hooks:
        def drifted(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            share = course.time / scale.duration
            out[row] += sign * size * (share**p + drift * (np.sin(2.0 * np.pi * turns * share + phase) - np.sin(phase)))
            return out

        return Hooks(sensor=((50.0, drifted),))

    top = {"elbow": 0.4, "sit_to_stand": 0.4}.get(scale.system, 0.15)

    def words(size: float) -> str:
        return f"{names[row]} drifts by {sign * size:.3g} in a trial"

    return Draw(1e-4 * most, top * most, hooks, words, names[row])


SENSOR_DRIFT = InjectionPlan(
    "sensor_drift",
    ALL,
    "power of time with a wander",
    "linear or exponential",
    draw,
)
