"""An attachment that creeps along the limb by a power of its load, the more easily the longer it is worn; no threshold.

planted:   s' = c sign(f) (|f|/F)^m (e + (t/T)^2) - r s, f = k (u - s), m = 3..5, e = 0.08..0.2, shoulder 0.88..1:
           sweat lets it go (Norton); r = 0 (elbow), 2..3 of 1/T: skin under a strap creeps back
candidate: s' = m sign(f) max(|f| - L, 0)
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap.benchmark.planted.compile import loop
from geocontact.gap.benchmark.planted.hooks import Hooks, Values
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale


@loop
def crept(
    time: Float[np.ndarray, " t"],
    u: Float[np.ndarray, " t"],
    d: float,
    c: float,
    m: float,
    begin: float,
    whole: float,
    back: float,
) -> Float[np.ndarray, " t"]:
    """Deflection left; fourth-order Runge-Kutta, as many steps as keep each far below the stroke `d`."""
    out = np.empty(u.size)
    s = 0.0
    out[0] = u[0]
    k = np.zeros(4)
    for i in range(1, u.size):
        h, du = time[i] - time[i - 1], u[i] - u[i - 1]
        easy = c * (begin + (time[i] / whole) ** 2)
        stiffness = easy * m / d * max(abs((u[i] - s) / d), 0.05) ** (m - 1.0)
        pieces = int(4.0 * h * stiffness) + 1
        step = h / pieces
        for j in range(pieces):
            for a in range(4):
                part = 0.0 if a == 0 else (1.0 if a == 3 else 0.5)
                share = (j + part) / pieces
                gone = s + (part * step * k[a - 1] if a > 0 else 0.0)
                e = (u[i - 1] + du * share - gone) / d
                at = (time[i - 1] + h * share) / whole
                k[a] = c * (begin + at * at) * np.sign(e) * abs(e) ** m - back * gone
            s += step * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3]) / 6.0
        out[i] = u[i] - s
    return out


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: creep rate c at the largest load in the end [m/s]."""
    m, begin = rng.uniform(3.0, 5.0), rng.uniform(0.08, 0.2)
    if scale.system == "shoulder":
        begin += 0.8
    back = rng.uniform(2.0, 3.0) / scale.duration if scale.system == "sit_to_stand" else 0.0

    def hooks(rate: float) -> Hooks:
        def attached(time: Values, u: Values, _: float) -> Values:
            return crept(time, u, scale.stroke, rate, m, begin, scale.duration, back)

        return Hooks(attachment=(attached,))

    most = 6.0 * scale.stroke / scale.duration
    return Draw(1e-4 * most, most, hooks, lambda c: f"the cuff creeps by {c:.3g} m/s under the largest load in the end")


SLIP = Plan(
    "slip",
    ("elbow", "shoulder", "sit_to_stand"),
    "Norton creep that grows with time",
    "Bingham above a limit",
    draw,
    placed=True,
)
