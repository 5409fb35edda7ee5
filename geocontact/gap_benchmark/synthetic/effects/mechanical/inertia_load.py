"""A mass that is an extended body.

planted:   elbow: m l (beta'' + e beta'^2 + e' beta''(t) cos(beta)); foot: masses at heel and toe, vertical and
           forward parts differ by the share that the leg carries, both low-passed by the soft heel (4 ms);
           shoulder: as at the elbow, at the sensor; or m l^2 (1 + e' cos(e)) e'' through a soft bracket (20..40 ms) at
           the exoskeleton's hinge, l = 0.3 m
candidate: elbow: m l beta'' or m d_tot''; foot: one point mass on the sole; shoulder: m L_h a'', or an inertia
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.effects.mechanical.relaxation import settled
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

LEVER = {"elbow": "l_ex", "shoulder": "L_h"}
"""Where the mass at the sensor sits."""
REACH = 0.3
"""Where one sits on the exoskeleton's arm [m]."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: mass m [kg]."""
    sign = rng.choice([-1.0, 1.0])
    spin, lean = rng.uniform(0.25, 0.35), rng.uniform(0.15, 0.25)
    ahead, leg = rng.uniform(0.05, 0.15), rng.uniform(0.08, 0.15)
    soft = rng.uniform(0.02, 0.04)
    on_exo = scale.system == "shoulder" and rng.random() < 0.5

    def hooks(mass: float) -> Hooks:
        def swung(course: InputCourse, numbers: Mapping[str, float]) -> Outputs:
            beta, rate, acceleration = course.position[0], course.rate[0], course.acceleration[0]
            along = acceleration * (1.0 + lean * np.cos(beta)) + spin * rate**2
            added = np.zeros((len(scale.output), len(beta)))
            added[scale.loads[0]] = sign * mass * numbers[LEVER[scale.system]] * along
            return added

        def bracketed(p: Swing) -> Values:
            h = float(p.time[1] - p.time[0])
            return np.asarray(
                mass * REACH**2 * settled(((1.0 + lean * np.cos(p.angle)) * p.acceleration)[:, None], h, soft)[:, 0]
            )

        def stepped(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            s, c = np.sin(course.position[2]), np.cos(course.position[2])
            turn, swing = course.acceleration[2], course.rate[2] ** 2
            x = course.acceleration[0] - ahead * (turn * s + swing * c)
            y = course.acceleration[1] + ahead * (turn * c - swing * s)
            h = float(course.time[1] - course.time[0])
            late = settled(np.column_stack([(1.0 + leg) * x, (1.0 - leg) * y]), h, 0.004)
            return np.array([mass * late[:, 0], mass * late[:, 1], np.zeros_like(x)])

        if on_exo:
            return Hooks(hinge=(bracketed,))
        return Hooks(load=(stepped if scale.system == "foot" else swung,))

    most = {"elbow": 4.0, "shoulder": 0.5 if on_exo else 6.0}.get(scale.system, 8.0)
    variant = "" if scale.system != "shoulder" else ("exo" if on_exo else "cuff")
    where = " on the exoskeleton" if on_exo else ""
    return Draw(1e-3, most, hooks, lambda m: f"unmodelled mass{where} of {m:.3g} kg", variant)


INERTIA_LOAD = InjectionPlan(
    "inertia_load", ("elbow", "foot", "shoulder"), "extended body, softly coupled", "point mass", draw
)
