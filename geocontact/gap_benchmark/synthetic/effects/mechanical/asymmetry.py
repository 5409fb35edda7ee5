"""Loading is stiffer than unloading, and the change from one to the other takes time; a knee's sides differ.

planted:   foot: k (1 + a m), tau m' = r/sqrt(1 + r^2) - m, r = d'/v: a blend that remembers; weighted by 1 + s d/D
           knee: medial k (1 + a (1 + e (u/D - 1/2))), lateral k (1 - f a (1 + e (u/D - 1/2))): bone below the insert
           gives way, e = 1.0..1.4, f = 0.8..1.2
candidate: foot: k (1 + a tanh(d'/v)); knee: k (1 + a), k (1 - a)
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.effects.mechanical.relaxation import settled
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Between directions at the foot, between sides at the knee."""
    return sides(rng, scale) if scale.system == "knee" else directions(rng, scale)


def sides(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: excess a of one side [-]."""
    sign, bend, less = rng.choice([-1.0, 1.0]), rng.uniform(1.0, 1.4), rng.uniform(0.8, 1.2)

    def differing(share: float) -> Hooks:
        def factor(_: Values, u: Values, __: Values) -> Values:
            return np.asarray(1.0 + share * (1.0 + bend * (u / scale.stroke - 0.5)))

        return Hooks(spring=(factor,))

    def hooks(a: float) -> Hooks:
        return Hooks(places={"medial": differing(sign * a), "lateral": differing(-sign * less * a)})

    return Draw(1e-3, 0.35, hooks, lambda a: f"medial side {sign * a:+.2%} stiffer, lateral {-sign * less * a:+.2%}")


def directions(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: excess a [-]."""
    tau, turning = rng.uniform(0.004, 0.009), rng.uniform(0.1, 0.4) * scale.rate
    lean = rng.uniform(0.15, 0.25)

    def hooks(a: float) -> Hooks:
        def blend(time: Values, depth: Values, closing: Values) -> Values:
            r = closing / turning
            memory = settled(r / np.sqrt(1.0 + r * r), float(time[1] - time[0]), tau)
            return np.asarray(1.0 + a * memory * (1.0 + lean * (np.maximum(depth, 0.0) / scale.stroke - 0.5)))

        return Hooks(spring=(blend,))

    return Draw(2e-4, 0.35, hooks, lambda a: f"{a:.2%} stiffer while loading, softer while unloading, with a memory")


ASYMMETRY = InjectionPlan(
    "asymmetry",
    ("foot", "knee"),
    "blend with memory; sides that differ more under load",
    "tanh of rate; constant",
    draw,
)
