"""The joint's axis drifts along a smooth path.

planted:   x + a w tanh(phi/w) + c a sin(3 phi), phi = beta - middle, w = 0.9..1.3 rad; R of the knee with flexion, the
           lever of a site with its rotation: phi in units of half their range
           shoulder: o_x, phi = arm, because o_x is that of the hanging arm; c 2.5 times that
candidate: x + a phi + c phi^2
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

RADIUS, LEVER = 0.037, 0.1
"""A knee's radius; largest change of a lever [m]."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: slope a [m/rad] in the middle, of either sign."""
    letter, most, unit = {
        "elbow": ("x", 0.03, 1.0),
        "shoulder": ("o_x", 0.05, 1.0),
        "knee": ("R", 0.4 * RADIUS / scale.span, scale.span),
        "sit_to_stand": ("the lever", LEVER / scale.span, scale.span),
    }[scale.system]
    sign = rng.choice([-1.0, 1.0])
    width = rng.uniform(0.9, 1.3) if scale.departure == 1.0 else 3.0
    ripple = scale.departure * rng.uniform(0.06, 0.1) * (1.0 if scale.system == "elbow" else 1.8)
    middle = scale.middle
    if scale.system == "shoulder":
        middle, ripple = 0.0, 2.5 * ripple

    def hooks(slope: float) -> Hooks:
        def drift(angle: Values) -> Values:
            u = (angle - middle) / unit / width
            return np.asarray(sign * slope * unit * (width * np.tanh(u) + ripple * np.sin(3.0 * width * u)))

        return Hooks(axis=(drift,))

    return Draw(most / 3000.0, most, hooks, lambda a: f"{letter} moves by {sign * a:.3g} m per rad")


AXIS_MIGRATION = InjectionPlan(
    "axis_migration",
    ("elbow", "shoulder", "knee", "sit_to_stand"),
    "path that levels off and ripples",
    "parabola in the angle",
    draw,
    placed=True,
)
