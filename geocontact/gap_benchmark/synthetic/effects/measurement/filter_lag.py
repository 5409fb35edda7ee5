"""Outputs pass a low-pass that follows a rise and a fall differently.

planted:   y' = (u - y)/tau(u - y), tau = T (1 + e) rising, T (1 - e) falling, e = 0.3..0.4, then a second-order
           Butterworth with a fifth of that lag
candidate: two linear first-order stages
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


@loop
def follow(
    u: Float[np.ndarray, " t"], h: float, rising: float, falling: float, corner: float
) -> Float[np.ndarray, " t"]:
    """Filtered `u`; each stage by the midpoint rule, starting in step with a straight line."""
    out = np.empty(u.size)
    lag = 0.5 * (rising + falling)
    slope = (u[1] - u[0]) / h
    y = u[0] - lag * slope
    z, rate = y - slope * np.sqrt(2.0) / corner, slope
    out[0] = z
    for i in range(1, u.size):
        middle = 0.5 * (u[i] + u[i - 1])
        tau = rising if middle > y else falling
        before = y
        y = y + (middle - y) * h / (tau + 0.5 * h)
        # second order: z'' = corner^2 (y - z) - sqrt(2) corner z', trapezoidal
        a = 0.5 * h
        w2 = corner * corner
        damp = np.sqrt(2.0) * corner
        right = rate + a * (w2 * (before + y - 2.0 * z) - damp * rate - w2 * a * rate)
        new = right / (1.0 + a * damp + a * a * w2)
        z = z + a * (rate + new)
        rate = new
        out[i] = z
    return out


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: lag T [s] of slow signals."""
    uneven = scale.departure * rng.uniform(0.3, 0.4) * rng.choice([-1.0, 1.0])

    def hooks(lag: float) -> Hooks:
        def passed(course: InputCourse, outputs: Outputs) -> Outputs:
            first, corner = 0.8 * lag, np.sqrt(2.0) / (0.2 * lag)
            h = float(course.time[1] - course.time[0])
            rows = [follow(row, h, first * (1.0 + uneven), first * (1.0 - uneven), corner) for row in outputs]
            return np.array(rows)

        return Hooks(sensor=((30.0, passed),))

    longest = 0.05 if scale.system == "foot" else min(0.35, 0.06 * scale.duration)
    return Draw(0.001, longest, hooks, lambda t: f"low-pass with a lag of {t:.3g} s, uneven by {uneven:.0%}")


FILTER_LAG = InjectionPlan(
    "filter_lag",
    ALL,
    "direction-dependent first order, then Butterworth",
    "two linear stages",
    draw,
)
