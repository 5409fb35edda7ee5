"""Tissue that stiffens exponentially (elbow, straps); foam whose cells are taken up one after the other (foot).

planted:   elbow, straps: k u (1 + x (1 + e v/hypot(v, V))), x = (exp(a s) - 1)/(a s) - 1, s = |u|/D, with a little
           hysteresis, e = 0.015..0.026 (straps 0.06..0.1, shoulder 0.14..0.23)
           foot: k d^n (1 + a r(s)/r(1)), r(s) = s^m/(s^m + w^m), m = 3..4.5, w = 0.4..0.6
candidate: k u (1 + g (|u|/D)^p)
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: share a of stiffness gained, about, at the largest deflection [-]."""
    m, middle = rng.uniform(3.0, 4.5), rng.uniform(0.4, 0.6)
    lag = rng.uniform(0.015, 0.026) * {"shoulder": 9.0, "sit_to_stand": 4.0}.get(scale.system, 1.0)

    def hooks(a: float) -> Hooks:
        def tissue(_: Values, u: Values, rate: Values) -> Values:
            grown = np.minimum(np.maximum(a * np.abs(u) / scale.stroke, 1e-9), 30.0)
            way = np.sign(u) * rate / np.hypot(rate, scale.rate)  # loading +, unloading -
            return np.asarray(1.0 + (np.expm1(grown) / grown - 1.0) * (1.0 + lag * way))

        def foam(_: Values, depth: Values, __: Values) -> Values:
            power = (np.maximum(depth, 0.0) / scale.stroke) ** m
            return np.asarray(1.0 + a * power / (power + middle**m) * (1.0 + middle**m))

        return Hooks(spring=(foam if scale.system == "foot" else tissue,))

    return Draw(0.001, 3.0, hooks, lambda a: f"stiffens with deflection, by {a:.3g} times or so at the largest")


STIFFENING = InjectionPlan(
    "stiffening",
    ("elbow", "foot", "shoulder", "sit_to_stand"),
    "exponential with hysteresis; or levelling off",
    "power of deflection",
    draw,
    placed=True,
    together=True,
)
