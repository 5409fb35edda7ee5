"""A narrow line in the force: tremor or a resonance of the frame, 3..9 Hz at arms and straps, higher elsewhere."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes

PITCH = {
    "elbow": (3.0, 9.0),
    "foot": (15.0, 40.0),
    "shoulder": (3.5, 9.0),
    "knee": (7.0, 25.0),
    "sit_to_stand": (3.5, 9.0),
}
"""Range [Hz]; a third of the sampling frequency at most."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: of the oscillation [N]; its phase differs between trials."""
    low, high = PITCH[scale.system]
    if scale.system != "foot":
        high = min(high, 0.35 / scale.step)
    pitch, swell = rng.uniform(low, high), rng.uniform(0.0, 0.4)
    row = scale.load(rng)

    def hooks(size: float) -> Hooks:
        def shake(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            grown = 1.0 + swell * np.sin(2.0 * np.pi * 2.0 * course.time / course.duration)
            out[row] += size * grown * np.sin(2.0 * np.pi * pitch * course.time + course.phase)
            return out

        return Hooks(sensor=((5.0, shake),))

    return Draw(1e-4 * scale.force, 0.3 * scale.force, hooks, lambda a: f"a tremor of {a:.3g} N at {pitch:.1f} Hz")


TREMOR = InjectionPlan("tremor", ALL, "narrow line", "", draw)
