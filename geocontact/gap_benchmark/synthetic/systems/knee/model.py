"""The knee of CASES.md a second time: per side F = (4/3) E* a³/R from an area, with whatever is hooked in.

The deflection of a side is a³/R [m^2], its stiffness (4/3) E* [Pa].
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.body import SyntheticSystem
from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values, read
from geocontact.gap_benchmark.synthetic.systems.interface import pull

SIDES = ("medial", "lateral")
INPUTS = ("flexion", "adduction", *(f"area_{side}" for side in SIDES))
OUTPUTS = tuple(f"force_{side}" for side in SIDES)
UNITS = ("rad", "rad", "m^2", "m^2", "N", "N")
AREAS = slice(2, 4)
LEAST = 1e-9
"""Area that a side keeps [m^2]."""


def deflection(area: Values, radius: Values) -> Values:
    """(area/π)^(3/2)/R [m^2]."""
    return np.asarray((np.maximum(area, LEAST) / np.pi) ** 1.5 / radius)


def area_under(force: Values, modulus: float, radius: float) -> Values:
    """Area [m^2] that a force makes in the base model."""
    return np.asarray(np.pi * (0.75 * force * radius / modulus) ** (2.0 / 3.0))


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks) -> Float[np.ndarray, "c t"]:
    """force_medial and force_lateral [N] along a course."""
    for moved in hooks.motion:
        course = moved(course)
    flexion = course.position[0]
    radius = np.full_like(flexion, numbers["R"])
    for drift in hooks.axis:
        radius = radius + drift(flexion)
    k = 4.0 / 3.0 * numbers["E_star"]
    outputs = np.array(
        [
            pull(course.time, deflection(area, radius), k, hooks.seen_from(side))
            for side, area in zip(SIDES, course.position[AREAS], strict=True)
        ]
    )
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def base_model(course: InputCourse, constants: Mapping[str, float]) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (E_star,), one row per side."""
    u = deflection(course.position[AREAS], np.asarray(constants["R"]))

    def outputs(theta: Values) -> Values:
        return np.asarray(4.0 / 3.0 * theta[0] * u)

    return outputs


def course_deflection(course: InputCourse, numbers: Mapping[str, float]) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course, one row per side."""
    u = deflection(course.position[AREAS], np.asarray(numbers["R"]))
    return u, np.gradient(u, course.time, axis=1, edge_order=2)


KNEE = SyntheticSystem(
    respond, base_model, course_deflection, loads=(0, 1), normal=(0, 1), spare=INPUTS[:2], lengths=("R",)
)
