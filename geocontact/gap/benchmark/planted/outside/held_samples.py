"""Stretches in which the recorder repeats its last value."""

from __future__ import annotations

import numpy as np

from geocontact.gap.benchmark.planted.course import Course
from geocontact.gap.benchmark.planted.hooks import Hooks, Outputs
from geocontact.gap.benchmark.planted.plan import ALL, Draw, Plan, Rng, Scale


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: duration of a stretch as a share of the trial [-]; where they lie differs between trials."""
    count = int(rng.integers(3, 7))
    golden = 0.6180339887

    def hooks(share: float) -> Hooks:
        def held(course: Course, outputs: Outputs) -> Outputs:
            begin = np.sort((course.phase / (2.0 * np.pi) + golden * np.arange(1, count + 1)) % 1.0) * course.duration
            at = course.time.copy()
            for one in begin:
                inside = (course.time >= one) & (course.time < one + share * course.duration)
                at[inside] = np.minimum(at[inside], one)
            # the recorder repeats a sample, so it is a sample's time that is repeated
            at = np.where(at < course.time, np.floor(at / scale.step) * scale.step, course.time)
            return np.array([np.interp(at, course.time, row) for row in outputs])

        return Hooks(sensor=((80.0, held),))

    return Draw(0.002, 0.12, hooks, lambda s: f"{count} stretches of {s:.2%} of a trial in which values are repeated")


HELD_SAMPLES = Plan("held_samples", ALL, "held samples", "", draw)
