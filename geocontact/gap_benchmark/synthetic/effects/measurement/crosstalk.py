"""Channels couple more at slow than at quick loads.

planted:   a += chi (s c + (1 - s) low-pass of c with 20..40 ms; knee 50..80, straps 40..70), c = b; straps
           c = b (1 + e (|b|/B - 1/2)), e = 0.6..0.9
candidate: a += chi b
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.effects.mechanical.relaxation import settled
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

LAG = {"foot": (0.02, 0.04), "knee": (0.05, 0.08), "sit_to_stand": (0.04, 0.07)}
"""Range of the time of the slow part [s]."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: share chi [-], of either sign."""
    to, source = (0, 1) if rng.random() < 0.7 else (1, 0)
    if scale.system != "foot":
        to, source = (int(row) for row in rng.choice(scale.loads, 2, replace=False))
    sign, prompt, tau = rng.choice([-1.0, 1.0]), rng.uniform(0.1, 0.3), rng.uniform(*LAG[scale.system])
    names = tuple(scale.output)
    most = scale.output[names[source]]
    bend = rng.uniform(0.6, 0.9) if scale.system == "sit_to_stand" else 0.0

    def hooks(share: float) -> Hooks:
        def coupled(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            h = float(course.time[1] - course.time[0])
            felt = outputs[source] * (1.0 + bend * (np.abs(outputs[source]) / most - 0.5))
            late = settled(felt[:, None], h, tau)[:, 0]
            out[to] += sign * share * (prompt * felt + (1.0 - prompt) * late)
            return out

        return Hooks(sensor=((10.0, coupled),))

    words = names[source], names[to]
    variant = f"{words[0]}_in_{words[1]}"
    return Draw(1e-4, 0.3, hooks, lambda x: f"{sign * x:.2%} of {words[0]} shows in {words[1]}", variant)


CROSSTALK = InjectionPlan(
    "crosstalk",
    ("foot", "knee", "sit_to_stand"),
    "frequency-dependent coupling",
    "constant coupling",
    draw,
)
