"""A push on the tool while it runs: it grows as the screw goes in, more with the arm up, and is let go faster.

planted:   P z (1 + s (t_on/t_1 - 1/2)) (1 + e sin(a - middle)), z' = (event - z)/tau, tau = 60..120 ms on, 20..40 ms
           off, t_on the time since the tool was started, t_1 = 2 s, s = 0.15..0.3, e = 0.1..0.2
candidate: P z, z the flag behind one lag
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

SCREW = 2.0
"""Time that a screw takes [s]."""


@loop
def pushed(
    on: Float[np.ndarray, " t"], h: float, rising: float, falling: float, growth: float, screw: float
) -> Float[np.ndarray, " t"]:
    """The push over P; each sample's flag holds until the next."""
    out = np.empty(on.size)
    z, since = 0.0, 0.0
    for i in range(on.size):
        out[i] = z * (1.0 + growth * (since / screw - 0.5))
        tau = rising if on[i] > 0.5 else falling
        z += (on[i] - z) * -np.expm1(-h / tau)
        if on[i] > 0.5:
            since = min(since + h, screw)
        elif z < 0.01:
            since = 0.0
    return out


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: push P [N], of either sign."""
    rising, falling = rng.uniform(0.06, 0.12), rng.uniform(0.02, 0.04)
    growth, lean = rng.uniform(0.15, 0.3), rng.uniform(0.1, 0.2)
    sign = rng.choice([-1.0, 1.0])

    def hooks(push: float) -> Hooks:
        def leant(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            added = np.zeros((len(scale.output), len(course.time)))
            on = (course.position[1] > 0.5).astype(float)  # what is recorded of the flag runs along a spline
            z = pushed(on, float(course.time[1] - course.time[0]), rising, falling, growth, SCREW)
            raised = 1.0 + lean * np.sin(course.position[0] - scale.middle)
            added[scale.loads[0]] = sign * push * z * raised
            return added

        return Hooks(load=(leant,))

    return Draw(
        1e-3 * scale.force, 0.8 * scale.force, hooks, lambda p: f"a push of {sign * p:.3g} N while the tool runs"
    )


EVENT_LOAD = InjectionPlan(
    "event_load", ("shoulder",), "push that grows with time and angle, uneven lags", "push behind one lag", draw
)
