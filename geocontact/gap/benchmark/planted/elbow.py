"""The elbow of CASES.md a second time: F = k d_tot along a course, with whatever is hooked in."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

from geocontact.gap.benchmark.planted.course import Course
from geocontact.gap.benchmark.planted.hooks import Hooks, Pull, Values, read

INPUTS, OUTPUTS = ("beta",), ("force",)
TOLERANCE = 1e-11
"""Of a spring in series [rad]."""


class NotConvergedError(ArithmeticError):
    """The truth depends on the time step, or an equation was not solved."""


def deflection(beta: Values, x: Values, y: float, l: float, z: float) -> Values:
    """d_tot [m]."""
    s, c = np.sin(beta), np.cos(beta)
    d_lin = y + np.sqrt(l * l - x * x) - np.sqrt((l * s - x) ** 2 + (y + l * c) ** 2)
    return np.asarray(d_lin - z * (x * c + y * s) / (l + y * c - x * s))


def respond(course: Course, numbers: Mapping[str, float], hooks: Hooks) -> Float[np.ndarray, "c t"]:
    """Force along a course [N], one row."""
    for moved in hooks.motion:
        course = moved(course)
    beta, time = course.position[0], course.time
    l, z, x, y, k = (numbers[name] for name in ("l_ex", "z_ex", "x", "y", "k"))

    def stretch(angle: Values) -> Values:
        along = np.full_like(angle, x)
        for wander in hooks.axis:
            along = along + wander(angle)
        return deflection(angle, along, y, l, z)

    def pull(angle: Values) -> Values:
        u = stretch(angle)
        u_rate = np.gradient(u, time, edge_order=2)
        attached = u
        for creep in hooks.attachment:
            attached = creep(time, attached, k)
        for slack in hooks.play:
            attached = slack(attached)
        elastic = k * attached
        for factor in hooks.spring:
            elastic = elastic * factor(time, attached, u_rate)
        force = elastic
        for term in hooks.beside:
            force = force + term(Pull(time, u, u_rate, elastic))
        return force

    force = in_series(beta, pull, hooks) if hooks.series else pull(beta)
    outputs = force[None, :]
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def in_series(beta: Values, pull: Callable[[Values], Values], hooks: Hooks) -> Values:
    """Force where the angle gives way to it: damped fixed point on w = g(F(beta - w)), asserted to have converged."""
    way = np.zeros_like(beta)
    damping = 0.5
    for _ in range(400):
        force = pull(beta - way)
        target = sum(give(force) for give in hooks.series)
        if float(np.abs(target - way).max()) < TOLERANCE:
            return force
        way = way + damping * (target - way)
        if not np.isfinite(way).all():
            break
    raise NotConvergedError("the spring in series of the elbow was not solved")


def base_model(course: Course, constants: Mapping[str, float]) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k, x, y), one row."""
    beta = course.position[0]
    l, z = constants["l_ex"], constants["z_ex"]

    def outputs(theta: Values) -> Values:
        k, x, y = theta
        return np.asarray(k * deflection(beta, np.asarray(x), float(y), l, z))[None, :]

    return outputs


def course_deflection(course: Course, numbers: Mapping[str, float]) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course."""
    u = deflection(course.position[0], np.asarray(numbers["x"]), numbers["y"], numbers["l_ex"], numbers["z_ex"])
    return u, np.gradient(u, course.time, edge_order=2)
