"""Channels couple more at slow than at quick loads.

planted:   a += chi (s b + (1 - s) low-pass of b with 20..40 ms)
candidate: a += chi b
"""

from __future__ import annotations

from geocontact.gap.benchmark.planted.course import Course
from geocontact.gap.benchmark.planted.effects.relaxation import settled
from geocontact.gap.benchmark.planted.hooks import Hooks, Outputs
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: share chi [-], of either sign."""
    to = 0 if rng.random() < 0.7 else 1
    sign, prompt, tau = rng.choice([-1.0, 1.0]), rng.uniform(0.1, 0.3), rng.uniform(0.02, 0.04)

    def hooks(share: float) -> Hooks:
        def coupled(course: Course, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            source = outputs[1 - to]
            late = settled(source[:, None], float(course.time[1] - course.time[0]), tau)[:, 0]
            out[to] += sign * share * (prompt * source + (1.0 - prompt) * late)
            return out

        return Hooks(sensor=((10.0, coupled),))

    words = ("force_y", "force_x") if to == 0 else ("force_x", "force_y")
    variant = f"{words[0]}_in_{words[1]}"
    return Draw(1e-4, 0.3, hooks, lambda x: f"{sign * x:.2%} of {words[0]} shows in {words[1]}", variant)


CROSSTALK = Plan("crosstalk", ("foot",), "frequency-dependent coupling", "constant coupling", draw)
