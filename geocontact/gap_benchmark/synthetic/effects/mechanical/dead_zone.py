"""Slack that is taken up smoothly: padding at its edges.

planted:   u -> s log(1 + exp((u - w+)/s)) - s log(1 + exp((-u - w-)/s)), less its value at 0; s = 0.15..0.21 of w
           (shoulder, straps 1.5 times that)
candidate: u - min(max(u, -(1 - a) w), a w)
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: whole play w [m]."""
    softer = 1.5 if scale.system in ("shoulder", "sit_to_stand") else 1.0
    share, soft = rng.uniform(0.2, 0.8), softer * rng.uniform(0.15, 0.21)
    if scale.low > 0.0:  # all of it on the side where the strap moves
        share = 1.0 - 0.25 * share

    def hooks(width: float) -> Hooks:
        s = soft * width

        def taken_up(u: Values) -> Values:
            return np.asarray(
                s * np.logaddexp(0.0, (u - share * width) / s) - s * np.logaddexp(0.0, (-u - (1.0 - share) * width) / s)
            )

        return Hooks(play=(lambda u: taken_up(u) - taken_up(np.zeros(1))[0],))

    stroke = scale.high - scale.low
    # a strap that never comes to rest must have more play than it keeps, or it shows a constant only
    least = max(1e-3 * stroke, 1.05 * scale.low / share)
    most = max(0.45 * stroke, 1.6 * least)
    return Draw(least, most, hooks, lambda w: f"play of {w:.3g} m with soft edges")


DEAD_ZONE = InjectionPlan(
    "dead_zone", ("elbow", "shoulder", "sit_to_stand"), "softplus edges", "piecewise linear", draw, placed=True
)
