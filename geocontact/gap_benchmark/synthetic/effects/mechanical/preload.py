"""Strap tension that relaxes a little and falls as the strap is let out.

planted:   T (1 - r (1 - exp(-t/tau))) (1 + s tanh(2 u/D)), r = 0.05..0.12, s = 0.05..0.1; straps twice that,
           shoulder 4 times
candidate: T min(max(1 + c u, 0), 1)
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: tension at rest T [N]."""
    more = {"shoulder": 4.0, "sit_to_stand": 2.0}.get(scale.system, 1.0)
    lost, tau = more * scale.departure * rng.uniform(0.05, 0.12), scale.duration * rng.uniform(0.1, 0.3)
    pull = more * scale.departure * rng.uniform(0.05, 0.1)
    sign = rng.choice([-1.0, 1.0])

    def hooks(tension: float) -> Hooks:
        def strap(p: Pull) -> Values:
            relaxed = 1.0 + lost * np.expm1(-p.time / tau)
            return np.asarray(sign * tension * relaxed * (1.0 + pull * np.tanh(2.0 * p.deflection / scale.stroke)))

        return Hooks(beside=(strap,))

    return Draw(1e-3 * scale.force, 0.5 * scale.force, hooks, lambda t: f"strap tension of {sign * t:.3g} N at rest")


PRELOAD = InjectionPlan(
    "preload",
    ("elbow", "shoulder", "sit_to_stand"),
    "relaxing, deflection-dependent tension",
    "tension with slackening",
    draw,
    placed=True,
    together=True,
)
