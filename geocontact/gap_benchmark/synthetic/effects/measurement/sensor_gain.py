"""A sensor that is off in gain, a little more at high loads.

planted:   y (1 + g (1 + e (|y|/Y - 1/2))), e = 0.54..0.72; 0.8..1.1 at knee and shoulder; 1.2..1.6 for cop_x;
           0.08..0.11 for force_y, because base parameters nearly take a plain gain of it away
candidate: (1 + g) y
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes

BEND = {
    "elbow": (0.6,),
    "foot": (0.6, 0.09, 1.3),
    "shoulder": (0.9, 0.9),
    "knee": (0.9, 0.9),
    "sit_to_stand": (0.6, 0.6, 0.6),
}
"""About e, by output."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: gain error g [-], of either sign; of one channel, or both forces where base parameters take it."""
    rows = [int(rng.choice([0, 0, 1, 2]))] if scale.system == "foot" else [scale.load(rng)]
    if scale.system in ("foot", "knee") and scale.departure < 1.0:
        rows = [0, 1]
    names = tuple(scale.output)
    sign = rng.choice([-1.0, 1.0])
    bend = scale.departure * rng.uniform(0.9, 1.2) * BEND[scale.system][rows[-1]]

    def hooks(gain: float) -> Hooks:
        def scaled(_: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            for row in rows:
                load = np.abs(outputs[row]) / scale.output[names[row]]
                out[row] = outputs[row] * (1.0 + sign * gain * (1.0 + bend * (load - 0.5)))
            return out

        return Hooks(sensor=((20.0, scaled),))

    which = " and ".join(names[row] for row in rows)
    return Draw(1e-4, 0.4, hooks, lambda g: f"{which} read {sign * g:+.2%}", "forces" if len(rows) > 1 else which)


SENSOR_GAIN = InjectionPlan(
    "sensor_gain",
    ALL,
    "gain that changes with load",
    "constant gain",
    draw,
)
