"""An attachment that creeps along the limb by a power of its load, slower and slower, and stays there; no threshold.

planted:   s' = c sign(f) (|f|/F)^m (e/(e + t/T))^(2/3), f = k (u - s), m = 3..5, e = 0.02..0.1: primary creep, by
           Norton's law of the load and Andrade's of the time
candidate: s' = m sign(f) max(|f| - L, 0)
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


@loop
def slower(phase: float, begin: float) -> float:
    """Rate of primary creep at a phase of the trial, as a share of that at its beginning."""
    return float((begin / (begin + phase)) ** (2.0 / 3.0))


@loop
def crept(
    time: Float[np.ndarray, " t"], u: Float[np.ndarray, " t"], d: float, c: float, m: float, begin: float, whole: float
) -> Float[np.ndarray, " t"]:
    """Deflection left; fourth-order Runge-Kutta, as many steps as keep each far below the stroke `d`."""
    out = np.empty(u.size)
    s = 0.0
    out[0] = u[0]
    k = np.zeros(4)
    for i in range(1, u.size):
        h, du = time[i] - time[i - 1], u[i] - u[i - 1]
        stiffness = c * slower(time[i - 1] / whole, begin) * m / d * max(abs((u[i] - s) / d), 0.05) ** (m - 1.0)
        pieces = int(4.0 * h * stiffness) + 1
        step = h / pieces
        for j in range(pieces):
            for a in range(4):
                part = 0.0 if a == 0 else (1.0 if a == 3 else 0.5)
                gone = s + (part * step * k[a - 1] if a > 0 else 0.0)
                e = (u[i - 1] + du * (j + part) / pieces - gone) / d
                phase = (time[i - 1] + h * (j + part) / pieces) / whole
                k[a] = c * slower(phase, begin) * np.sign(e) * abs(e) ** m
            s += step * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3]) / 6.0
        out[i] = u[i] - s
    return out


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: creep rate c at the largest load when it is new [m/s]."""
    m, begin = rng.uniform(3.0, 5.0), rng.uniform(0.02, 0.1)

    def hooks(rate: float) -> Hooks:
        def attached(time: Values, u: Values, _: float) -> Values:
            return crept(time, u, scale.stroke, rate, m, begin, scale.duration)

        return Hooks(attachment=(attached,))

    most = 60.0 * scale.stroke / scale.duration
    return Draw(1e-4 * most, most, hooks, lambda c: f"the cuff creeps by {c:.3g} m/s under the largest load at first")


SLIP = InjectionPlan(
    "slip",
    ("elbow", "shoulder", "sit_to_stand"),
    "primary creep",
    "Bingham above a limit",
    draw,
    placed=True,
)
