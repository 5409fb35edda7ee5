"""What is carried besides the interface: a weight, a mass that is moved, a push while a tool runs."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.effects.kernels import pushed, settled
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

REACH = 0.3
"""Where a mass sits on an exoskeleton's arm [m]."""
HEAVIEST_ON_ARM = 0.5
"""Largest mass there [kg]."""
SCREW = 2.0
"""Time that a screw takes [s]."""


def gravity_load(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Weight of a body whose centre does not lie on the link; at the shoulder it hangs on either arm.

    planted:   W (sin(beta + phi) + e sin(3 beta)): a second mass that swings on its strap, e = 0.04..0.08,
               shoulder 2.5 times that; or W l (sin(e + phi) + e sin(3 e)) at the exoskeleton's hinge, l = 0.25 m
    candidate: W sin(beta + phi); or at the hinge
    amplitude: weight W [N], of either sense
    """
    lever = scale.numbers.hinge
    sign, phase = rng.choice([-1.0, 1.0]), rng.uniform(-0.15, 0.15)
    hanging = scale.departure * rng.uniform(0.04, 0.08) * scale.numbers.hanging
    on_exo = bool(lever) and (scale.departure < 1.0 or rng.random() < 0.3)
    if on_exo:
        sign, phase = 1.0, scale.departure * rng.uniform(-0.45, 0.45)

    def hooks(weight: float) -> Hooks:
        def pulled(p: Swing) -> Values:
            return np.asarray(weight * lever * (np.sin(p.angle + phase) + hanging * np.sin(3.0 * p.angle)))

        def hang(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            beta = course.position[0]
            added = np.zeros((len(scale.output), len(beta)))
            added[scale.loads[0]] = sign * weight * (np.sin(beta + phase) + hanging * np.sin(3.0 * beta))
            return added

        return Hooks(hinge=(pulled,)) if on_exo else Hooks(load=(hang,))

    where = " on the exoskeleton" if on_exo else ""
    variant = ("exo" if on_exo else "arm") if lever else ""
    words = f"unmodelled weight{where} of"
    return Draw(1e-3 * scale.force, 0.5 * scale.force, hooks, lambda w: f"{words} {sign * w:.3g} N", variant)


def inertia_load(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A mass that is an extended body.

    planted:   elbow: m l (beta'' + e beta'^2 + e' beta''(t) cos(beta)); foot: masses at heel and toe, vertical and
               forward parts differ by the share that the leg carries, both low-passed by the soft heel (4 ms);
               shoulder: as at the elbow, at the sensor; or m l^2 (1 + e' cos(e)) e'' through a soft bracket
               (20..40 ms) at the exoskeleton's hinge, l = 0.3 m
    candidate: elbow: m l beta'' or m d_tot''; foot: one point mass on the sole; shoulder: m L_h a'', or an inertia
    amplitude: mass m [kg]
    """
    numbers = scale.numbers
    sign = rng.choice([-1.0, 1.0])
    spin, lean = rng.uniform(0.25, 0.35), rng.uniform(0.15, 0.25)
    ahead, leg = rng.uniform(0.05, 0.15), rng.uniform(0.08, 0.15)
    soft = rng.uniform(0.02, 0.04)
    on_exo = bool(numbers.hinge) and rng.random() < 0.5

    def hooks(mass: float) -> Hooks:
        def swung(course: InputCourse, values: Mapping[str, float]) -> Outputs:
            beta, rate, acceleration = course.position[0], course.rate[0], course.acceleration[0]
            along = acceleration * (1.0 + lean * np.cos(beta)) + spin * rate**2
            added = np.zeros((len(scale.output), len(beta)))
            added[scale.loads[0]] = sign * mass * values[numbers.lever] * along
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
        return Hooks(load=(stepped if numbers.on_ground else swung,))

    most = HEAVIEST_ON_ARM if on_exo else numbers.heaviest
    variant = ("exo" if on_exo else "cuff") if numbers.hinge else ""
    where = " on the exoskeleton" if on_exo else ""
    return Draw(1e-3, most, hooks, lambda m: f"unmodelled mass{where} of {m:.3g} kg", variant)


def event_load(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A push on the tool while it runs: it grows as the screw goes in, more with the arm up, and is let go faster.

    planted:   P z (1 + s (t_on/t_1 - 1/2)) (1 + e sin(a - middle)), z' = (event - z)/tau, tau = 60..120 ms on,
               20..40 ms off, t_on the time since the tool was started, t_1 = 2 s, s = 0.15..0.3, e = 0.1..0.2
    candidate: P z, z the flag behind one lag
    amplitude: push P [N], of either sign
    """
    rising, falling = rng.uniform(0.06, 0.12), rng.uniform(0.02, 0.04)
    growth, lean = rng.uniform(0.15, 0.3), rng.uniform(0.1, 0.2)
    sign = rng.choice([-1.0, 1.0])

    def hooks(push: float) -> Hooks:
        def leant(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            added = np.zeros((len(scale.output), len(course.time)))
            on = (course.position[1] > 0.5).astype(float)  # what is recorded of the flag runs along a spline
            z = pushed(on, float(course.time[1] - course.time[0]), rising, falling, growth, SCREW)
            raised = 1.0 + lean * np.sin(course.position[0] - scale.middle)
            added[scale.loads[0]] = sign * push * z * raised
            return added

        return Hooks(load=(leant,))

    return Draw(
        1e-3 * scale.force, 0.8 * scale.force, hooks, lambda p: f"a push of {sign * p:.3g} N while the tool runs"
    )


GRAVITY_LOAD = InjectionPlan("gravity_load", "two masses, one swings", "sine of the angle", gravity_load)
INERTIA_LOAD = InjectionPlan("inertia_load", "extended body, softly coupled", "point mass", inertia_load)
EVENT_LOAD = InjectionPlan(
    "event_load", "push that grows with time and angle, uneven lags", "push behind one lag", event_load
)
