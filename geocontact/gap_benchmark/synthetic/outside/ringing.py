"""The plate or the frame rings after every blow: decaying oscillation from the strike on."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: of the first swing [N]; from a fixed phase of the stance on."""
    pitch, at, decay = rng.uniform(25.0, 60.0), rng.uniform(0.05, 0.2), rng.uniform(0.03, 0.08)
    row = int(rng.choice([0, 1]))

    def hooks(size: float) -> Hooks:
        def rung(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            since = np.maximum(course.time - at * course.duration, 0.0)
            out[row] += size * np.exp(-since / decay) * np.sin(2.0 * np.pi * pitch * since)
            return out

        return Hooks(sensor=((5.0, rung),))

    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda a: f"ringing of {a:.3g} N at {pitch:.0f} Hz")


RINGING = InjectionPlan("ringing", ("foot",), "decaying oscillation", "", draw)
