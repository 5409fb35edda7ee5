"""The shoulder exoskeleton of CASES.md a second time: an arm on a hinge that the recorded one drives.

The deflection of the interface is u = -r, its force positive where it supports; what is hooked in acts on them over the
whole trial, and so does what is hooked in at the hinge.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd
from jaxtyping import Float, Int
from scipy.interpolate import CubicSpline

from geocontact.gap_benchmark.synthetic.body import SyntheticSystem
from geocontact.gap_benchmark.synthetic.course import InputCourse, through
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Swing, Values, read
from geocontact.gap_benchmark.synthetic.systems.interface import NotConvergedError, in_series, pull
from geocontact.gap_benchmark.synthetic.systems.swing import GRAVITY, Arm, Torque, at_rest, follow, swing

INPUTS, OUTPUTS = ("arm", "event"), ("exo", "force")
UNITS = ("rad", "-", "rad", "N")
FORCE = 1
COARSEST = 2.5e-3
"""Longest step of the base model [s]."""
PARTS, SAME_TICK = 20, 1e-6
"""Into how many parts the shortest time between two samples may have to be cut; how exactly these must fit."""
SMALL = 1e-5
"""Change by which slopes are taken [rad or rad/s]."""
Numbers = Mapping[str, float]
Table = Float[np.ndarray, "two k"]
"""Angles [rad] and torques of full support [N m]."""


@dataclass(frozen=True)
class Driven:
    """What drives the arm: the sphere's place from the hinge and its rate, rows x, y, x', y', over time [s]."""

    time: Float[np.ndarray, " t"]
    way: Float[np.ndarray, "four t"]

    def off(self, angle: Values) -> Values:
        """u = -r [m] at an angle of the arm."""
        return np.asarray(-self.way[0] * np.cos(angle) - self.way[1] * np.sin(angle))

    def along(self, angle: Values) -> Values:
        """s [m]."""
        return np.asarray(self.way[0] * np.sin(angle) - self.way[1] * np.cos(angle))

    @property
    def still(self) -> Driven:
        """As if it rested where it begins."""
        begin = np.repeat(self.way[:, :1], 3, axis=1)
        begin[2:] = 0.0
        return Driven(self.time[:3], begin)


def driven(course: InputCourse, numbers: Numbers, hooks: Hooks) -> Driven:
    """p = L_h (sin a, -cos a) less the hinge, which may drift with the arm."""
    angle, rate = course.position[0], course.rate[0]
    s, c, l = np.sin(angle), np.cos(angle), numbers["L_h"]
    o_x = np.full_like(angle, numbers["o_x"])
    for drift in hooks.axis:
        o_x = o_x + drift(angle)
    drift = np.gradient(o_x, course.time, edge_order=2)
    way = np.array([l * s - o_x, -l * c - numbers["o_y"], l * c * rate - drift, l * s * rate])
    return Driven(course.time, way)


def carried(time: Float[np.ndarray, " t"], u: Values, numbers: Numbers, hooks: Hooks) -> Values:
    """Force of the interface [N]; behind a spring in series the dashpot lies beside both springs."""
    k, b = numbers["k_t"], numbers["b_t"]
    if not hooks.series:
        return pull(time, u, k, hooks, b)
    elastic = in_series(u, partial(pull, time, k=k, hooks=hooks), hooks)
    return np.asarray(elastic + b * np.gradient(u, time, edge_order=2))


def torque_beyond(drive: Driven, numbers: Numbers, hooks: Hooks) -> Torque:
    """What the hooks make of the interface and of the hinge, less what the base model has [N m]."""
    time = drive.time

    def further(angle: Values) -> Values:
        u = drive.off(angle)
        force = carried(time, u, numbers, hooks)
        torque = (carried(time, u, numbers, BASE) - force) * drive.along(angle)
        rate = np.gradient(angle, time, edge_order=2)
        acceleration = np.gradient(rate, time, edge_order=2)
        acceleration[1:-1] = np.diff(angle, 2) / (time[1] - time[0]) ** 2
        return np.asarray(torque - sum(held(Swing(time, angle, rate, acceleration, force)) for held in hooks.hinge))

    return further


def arm_of(course: InputCourse, numbers: Numbers, table: Table) -> Arm:
    """The arm at a trial's level of support."""
    weight = numbers["m"] * GRAVITY * numbers["l_c"]
    torque = course.setting["level"] * table[1]
    return Arm(numbers["I"], numbers["c"], weight, numbers["k_t"], numbers["b_t"], table[0], torque)


def moved(course: InputCourse, numbers: Numbers, hooks: Hooks, table: Table) -> tuple[Driven, Values]:
    """What drives the arm, and the arm's angle, on a course whose samples are evenly apart."""
    drive, arm = driven(course, numbers, hooks), arm_of(course, numbers, table)
    begin = drive.still.way[:, 0]
    changed = bool(hooks.hinge or hooks.series or hooks.play or hooks.has_memory_in_law)
    further = torque_beyond(drive, numbers, hooks) if changed else None
    beyond = torque_beyond(drive.still, numbers, hooks) if changed else None

    def torque(e: float) -> float:
        more = 0.0 if beyond is None else float(beyond(np.full(3, e))[0])
        return float(arm.driven(np.asarray(e), np.zeros(()), begin)[0]) + more

    rest = at_rest(torque, float(np.arctan2(begin[0], -begin[1])))
    return drive, swing(float(course.time[1] - course.time[0]), drive.way, arm, further, rest)


def respond(course: InputCourse, numbers: Numbers, hooks: Hooks, table: Table) -> Float[np.ndarray, "c t"]:
    """exo [rad] and force [N] along a course."""
    for change in hooks.motion:
        course = change(course)
    drive, angle = moved(course, numbers, hooks, table)
    outputs = np.array([angle, carried(course.time, drive.off(angle), numbers, hooks)])
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def tick(time: Float[np.ndarray, " t"]) -> float:
    """Longest step that leads to every sample [s]: the shortest between two, or a whole part of it."""
    apart = np.diff(time)
    for parts in range(1, PARTS + 1):
        along = apart * parts / apart.min()
        if float(np.abs(along - np.round(along)).max()) < SAME_TICK:
            return float(apart.min() / parts)
    raise NotConvergedError("samples are apart by no whole number of steps")


def finer(course: InputCourse) -> tuple[InputCourse, Int[np.ndarray, " s"]]:
    """Steps of at most `COARSEST`, evenly apart also where rows were lost; and which of them are the course's."""
    step = tick(course.time)
    h = step / np.ceil(step / COARSEST - 1e-6)
    rows = np.round((course.time - course.time[0]) / h).astype(int)
    path = through(course.time, course.position, course.duration, course.phase, course.setting)
    return path(course.time[0] + h * np.arange(rows[-1] + 1)), rows


def base_model(course: InputCourse, constants: Numbers, table: Table) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k_t, b_t, m)."""
    fine, rows = finer(course)

    def outputs(theta: Values) -> Values:
        k, b, m = (float(value) for value in theta)
        numbers = {**constants, "k_t": k, "b_t": b, "m": m}
        drive, angle = moved(fine, numbers, BASE, table)
        return np.array([angle, carried(fine.time, drive.off(angle), numbers, BASE)])[:, rows]

    return outputs


def course_deflection(course: InputCourse, numbers: Numbers, table: Table) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course."""
    fine, rows = finer(course)
    drive, angle = moved(fine, numbers, BASE, table)
    u = drive.off(angle)
    return u[rows], np.gradient(u, fine.time, edge_order=2)[rows]


def passed_on(course: InputCourse, numbers: Numbers, row: int, noise: Values, table: Table) -> Values:
    """What small noise of an input makes of the outputs, "c t q" for "t q": the base model, linear about its motion."""
    if row:
        return np.zeros((len(OUTPUTS), *noise.shape))
    fine, rows = finer(course)
    h = float(fine.time[1] - fine.time[0])
    drive, angle = moved(fine, numbers, BASE, table)
    arm, rate = arm_of(course, numbers, table), np.gradient(angle, h, edge_order=2)

    def slope(name: str) -> tuple[Values, Values]:
        sides = [replace(fine, **{name: getattr(fine, name) + change}) for change in (SMALL, -SMALL)]
        more, less = (driven(side, numbers, BASE).way for side in sides)
        return half(arm.driven(angle, rate, more), arm.driven(angle, rate, less))

    by_arm, by_arm_rate = slope("position"), slope("rate")
    by_angle = half(*(arm.driven(angle + sign * SMALL, rate, drive.way) for sign in (1.0, -1.0)))
    by_rate = half(*(arm.driven(angle, rate + sign * SMALL, drive.way) for sign in (1.0, -1.0)))
    spline = CubicSpline(course.time, noise)
    shaken, shaking = spline(fine.time), spline(fine.time, 1)
    push, added = (by_arm[i][:, None] * shaken + by_arm_rate[i][:, None] * shaking for i in (0, 1))
    rest = -by_arm[0][0] / by_angle[0][0] * shaken[0]
    x = follow(h, arm.inertia, by_angle[0], by_rate[0], push, rest)
    force = added + by_angle[1][:, None] * x + by_rate[1][:, None] * np.gradient(x, h, axis=0, edge_order=2)
    return np.array([x[rows], force[rows]])


def half(more: tuple[Values, Values], less: tuple[Values, Values]) -> tuple[Values, Values]:
    """Slopes of torque and force by central differences."""
    torque, force = ((a - b) / (2.0 * SMALL) for a, b in zip(more, less, strict=True))
    return torque, force


def shoulder(support: pd.DataFrame) -> SyntheticSystem:
    """An exoskeleton with this support."""
    table = support[["angle [rad]", "torque [N m]"]].to_numpy(float).T.copy()
    return SyntheticSystem(
        partial(respond, table=table),
        partial(base_model, table=table),
        partial(course_deflection, table=table),
        loads=(FORCE,),
        normal=(FORCE,),
        spare=INPUTS[1:],
        lengths=("L_h", "o_x", "o_y", "l_c"),
        passed_on=partial(passed_on, table=table),
        fine=4,
    )
