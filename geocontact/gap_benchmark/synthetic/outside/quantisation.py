"""A converter with too few steps; noise is rounded with the rest."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: height of a step in the channel's unit."""
    names = tuple(scale.output)
    row = scale.load(rng)
    most = scale.output[names[row]]
    zero = rng.uniform()

    def hooks(step: float) -> Hooks:
        def rounded(_: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            out[row] = (np.round(outputs[row] / step + zero) - zero) * step
            return out

        return Hooks(recorder=(rounded,))

    return Draw(1e-3 * most, 0.3 * most, hooks, lambda s: f"{names[row]} comes in steps of {s:.3g}")


QUANTISATION = InjectionPlan("quantisation", ALL, "coarse steps", "", draw)
