"""Stretches in which the recorder repeats its last value."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: duration of a stretch as a share of the trial [-]; where they lie differs between trials."""
    count = int(rng.integers(3, 7))
    golden = 0.6180339887

    def hooks(share: float) -> Hooks:
        def held(course: InputCourse, outputs: Outputs) -> Outputs:
            begin = np.sort((course.phase / (2.0 * np.pi) + golden * np.arange(1, count + 1)) % 1.0) * course.duration
            given = np.arange(len(course.time))
            for one in begin:
                inside = (course.time >= one) & (course.time < one + share * course.duration)
                given[inside] = given[max(int(np.searchsorted(course.time, one)) - 1, 0)]
            return outputs[:, given]

        return Hooks(recorder=(held,))

    return Draw(0.002, 0.12, hooks, lambda s: f"{count} stretches of {s:.2%} of a trial in which values are repeated")


HELD_SAMPLES = InjectionPlan("held_samples", ALL, "held samples", "", draw)
