"""A stop with a rubber buffer.

planted:   P (0.6 v + 0.4 v^2)/(that at D) (1 + e u'/hypot(u', V)), v = b log(1 + exp((u - u1)/(b (D - u1)))),
           b = 0.12..0.2; rubber gives back less than it took, e = 0.12..0.2, straps 2.5, shoulder 4 times that
candidate: K max(u - u1, 0), or K D (max(u - u1, 0)/D)^1.5
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: force of the stop at the largest deflection [N]."""
    side = 1.0 if rng.random() < 0.7 else -1.0
    beyond = rng.uniform(0.1, 0.28) * (scale.high - scale.low)
    limit = scale.high - beyond if side > 0.0 else scale.low + beyond
    lossy = {"shoulder": 4.0, "sit_to_stand": 2.5}.get(scale.system, 1.0)
    buffer, loss = rng.uniform(0.12, 0.2), lossy * rng.uniform(0.12, 0.2)

    def swell(depth: Values) -> Values:
        v = buffer * np.logaddexp(0.0, depth / beyond / buffer)
        return np.asarray(0.6 * v + 0.4 * v * v)

    whole = float(swell(np.array([beyond]))[0])

    def hooks(most: float) -> Hooks:
        def stop(p: Pull) -> Values:
            way = side * p.rate / np.hypot(p.rate, scale.rate)
            return np.asarray(side * most * swell(side * (p.deflection - limit)) / whole * (1.0 + loss * way))

        return Hooks(beside=(stop,))

    def words(most: float) -> str:
        return f"a buffered end stop from {limit:.3g} m on, {most:.3g} N at the end"

    return Draw(1e-3 * scale.force, 1.2 * scale.force, hooks, words, "upper" if side > 0.0 else "lower")


END_STOP = InjectionPlan(
    "end_stop",
    ("elbow", "shoulder", "sit_to_stand"),
    "soft corner, hardening, lossy",
    "linear or a power beyond a corner",
    draw,
    placed=True,
)
