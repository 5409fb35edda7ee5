"""A mass that is an extended body.

planted:   elbow: m l (beta'' + e beta'^2 + e' beta''(t) cos(beta)); foot: masses at heel and toe, vertical and
           forward parts differ by the share that the leg carries, both low-passed by the soft heel (4 ms)
candidate: elbow: m l beta'' or m d_tot''; foot: one point mass on the sole
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap.benchmark.planted.course import Course
from geocontact.gap.benchmark.planted.effects.relaxation import settled
from geocontact.gap.benchmark.planted.hooks import Hooks, Outputs
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: mass m [kg]."""
    sign = rng.choice([-1.0, 1.0])
    spin, lean = rng.uniform(0.25, 0.35), rng.uniform(0.15, 0.25)
    ahead, leg = rng.uniform(0.05, 0.15), rng.uniform(0.08, 0.15)

    def hooks(mass: float) -> Hooks:
        def swung(course: Course, numbers: Mapping[str, float]) -> Outputs:
            beta, rate, acceleration = course.position[0], course.rate[0], course.acceleration[0]
            along = acceleration * (1.0 + lean * np.cos(beta)) + spin * rate**2
            return np.asarray(sign * mass * numbers["l_ex"] * along)[None]

        def stepped(course: Course, _: Mapping[str, float]) -> Outputs:
            s, c = np.sin(course.position[2]), np.cos(course.position[2])
            turn, swing = course.acceleration[2], course.rate[2] ** 2
            x = course.acceleration[0] - ahead * (turn * s + swing * c)
            y = course.acceleration[1] + ahead * (turn * c - swing * s)
            h = float(course.time[1] - course.time[0])
            soft = settled(np.column_stack([(1.0 + leg) * x, (1.0 - leg) * y]), h, 0.004)
            return np.array([mass * soft[:, 0], mass * soft[:, 1], np.zeros_like(x)])

        return Hooks(load=(stepped if scale.system == "foot" else swung,))

    return Draw(1e-3, 4.0 if scale.system == "elbow" else 8.0, hooks, lambda m: f"unmodelled mass of {m:.3g} kg")


INERTIA_LOAD = Plan("inertia_load", ("elbow", "foot"), "extended body, softly coupled", "point mass", draw)
