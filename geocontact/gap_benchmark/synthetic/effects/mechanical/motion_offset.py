"""One input is biased, by more at one end of its range than at the other: soft tissue.

planted:   recorded + o (1 + e sin((q - middle)/w)), e = 0.2..0.3, q the angle (elbow, shoulder), the pitch (foot),
           flexion (knee, whose areas are biased) or the rotation of the site
candidate: recorded + o
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


@dataclass(frozen=True)
class Biased:
    """An input that may be biased: row, largest bias, unit; and the angle that the bias varies with, its middle, w."""

    name: str
    row: int
    most: float
    unit: str
    by: int
    middle: float
    width: float


def known(scale: SyntheticMagnitudes) -> tuple[Biased, ...]:
    """Inputs of a system that may be biased."""
    if scale.system == "elbow":
        return (Biased("beta", 0, 0.3, "rad", 0, scale.middle, 0.5),)
    if scale.system == "shoulder":
        return (Biased("arm", 0, 0.15, "rad", 0, scale.middle, 0.7 * scale.span),)
    if scale.system == "foot":
        return Biased("y", 1, 0.004, "m", 2, -0.1, 0.25), Biased("pitch", 2, 0.06, "rad", 2, -0.1, 0.25)
    if scale.system == "knee":
        areas = enumerate(("area_medial", "area_lateral"), 2)
        return tuple(Biased(name, row, 8e-5, "m^2", 0, scale.middle, 0.7 * scale.span) for row, name in areas)
    sites = enumerate(scale.places.items())
    return tuple(Biased(f"{s}_normal", 3 * i, 0.004, "m", 3 * i + 2, p.middle, 0.7 * p.span) for i, (s, p) in sites)


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: bias in the input's unit, of either sign."""
    may_be = known(scale)
    one = may_be[0] if len(may_be) == 1 else may_be[rng.integers(len(may_be))]
    row, by = one.row, one.by
    bend = scale.departure * rng.uniform(0.2, 0.3)
    sign = rng.choice([-1.0, 1.0])

    def hooks(size: float) -> Hooks:
        def moved(course: InputCourse) -> InputCourse:
            angle = (course.position[by] - one.middle) / one.width
            s, c = np.sin(angle), np.cos(angle)
            turn, spin = course.rate[by] / one.width, course.acceleration[by] / one.width
            position, rate, acceleration = course.position.copy(), course.rate.copy(), course.acceleration.copy()
            position[row] += sign * size * (1.0 + bend * s)
            rate[row] += sign * size * bend * c * turn
            acceleration[row] += sign * size * bend * (c * spin - s * turn**2)
            return replace(course, position=position, rate=rate, acceleration=acceleration)

        return Hooks(motion=(moved,))

    def words(size: float) -> str:
        return f"{one.name} is off by {sign * size:.3g} {one.unit}, a little more at one end of the range"

    return Draw(1e-4 * one.most, one.most, hooks, words, one.name)


MOTION_OFFSET = InjectionPlan(
    "motion_offset",
    ALL,
    "bias that varies with the angle",
    "constant bias",
    draw,
)
