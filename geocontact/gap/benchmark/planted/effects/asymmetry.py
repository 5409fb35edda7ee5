"""Loading is stiffer than unloading, and the change from one to the other takes time.

planted:   k (1 + a m), tau m' = r/sqrt(1 + r^2) - m, r = d'/v: a blend that remembers; weighted by 1 + s d/D
candidate: k (1 + a tanh(d'/v))
"""

from __future__ import annotations

import numpy as np

from geocontact.gap.benchmark.planted.effects.relaxation import settled
from geocontact.gap.benchmark.planted.hooks import Hooks, Values
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale


def draw(rng: Rng, scale: Scale) -> Draw:
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


ASYMMETRY = Plan("asymmetry", ("foot",), "blend with memory", "tanh of rate", draw)
