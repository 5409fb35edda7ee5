"""The elbow of CASES.md a second time: F = k d_tot along a course, with whatever is hooked in."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.body import SyntheticSystem
from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values, read
from geocontact.gap_benchmark.synthetic.systems.interface import in_series, pull

INPUTS, OUTPUTS = ("beta",), ("force",)


def deflection(beta: Values, x: Values, y: float, l: float, z: float) -> Values:
    """d_tot [m]."""
    s, c = np.sin(beta), np.cos(beta)
    d_lin = y + np.sqrt(l * l - x * x) - np.sqrt((l * s - x) ** 2 + (y + l * c) ** 2)
    return np.asarray(d_lin - z * (x * c + y * s) / (l + y * c - x * s))


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks) -> Float[np.ndarray, "c t"]:
    """Force along a course [N], one row."""
    for moved in hooks.motion:
        course = moved(course)
    beta, time = course.position[0], course.time
    l, z, x, y, k = (numbers[name] for name in ("l_ex", "z_ex", "x", "y", "k"))

    def stretch(angle: Values) -> Values:
        along = np.full_like(angle, x)
        for drift in hooks.axis:
            along = along + drift(angle)
        return deflection(angle, along, y, l, z)

    def carried(angle: Values) -> Values:
        return pull(time, stretch(angle), k, hooks)

    force = in_series(beta, carried, hooks) if hooks.series else carried(beta)
    outputs = force[None, :]
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def base_model(course: InputCourse, constants: Mapping[str, float]) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k, x, y), one row."""
    beta = course.position[0]
    l, z = constants["l_ex"], constants["z_ex"]

    def outputs(theta: Values) -> Values:
        k, x, y = theta
        return np.asarray(k * deflection(beta, np.asarray(x), float(y), l, z))[None, :]

    return outputs


def course_deflection(course: InputCourse, numbers: Mapping[str, float]) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course."""
    u = deflection(course.position[0], np.asarray(numbers["x"]), numbers["y"], numbers["l_ex"], numbers["z_ex"])
    return u, np.gradient(u, course.time, edge_order=2)


ELBOW = SyntheticSystem(respond, base_model, course_deflection, lengths=("l_ex", "z_ex"))
