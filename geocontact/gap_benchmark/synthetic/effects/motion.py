"""What becomes of the motion before it reaches an interface: a biased input, an axis that drifts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def motion_offset(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """One input is biased, by more at one end of its range than at the other: soft tissue.

    planted:   recorded + o (1 + e sin((q - middle)/w)), e = 0.2..0.3, q the angle (elbow, shoulder), the pitch (foot),
               flexion (knee, whose areas are biased) or the rotation of the site
    candidate: recorded + o
    amplitude: bias in the input's unit, of either sign
    """
    may_be = scale.numbers.biased(scale)
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


def axis_migration(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """The joint's axis drifts along a smooth path.

    planted:   x + a w tanh(phi/w) + c a sin(3 phi), phi = beta - middle, w = 0.9..1.3 rad; R of the knee with flexion,
               the lever of a site with its rotation: phi in units of half their range
               shoulder: o_x, phi = arm, because o_x is that of the hanging arm; c 2.5 times that
    candidate: x + a phi + c phi^2
    amplitude: slope a [m/rad] in the middle, of either sign
    """
    axis = scale.numbers.axis
    if axis is None:
        raise ValueError("this system has no axis that could drift")
    unit = scale.span if axis.over_range else 1.0
    most = axis.most / scale.span if axis.over_range else axis.most
    sign = rng.choice([-1.0, 1.0])
    width = rng.uniform(0.9, 1.3) if scale.departure == 1.0 else 3.0
    ripple = scale.departure * rng.uniform(0.06, 0.1) * axis.ripple
    middle = scale.middle
    if axis.hanging:
        middle, ripple = 0.0, 2.5 * ripple

    def hooks(slope: float) -> Hooks:
        def drift(angle: Values) -> Values:
            u = (angle - middle) / unit / width
            return np.asarray(sign * slope * unit * (width * np.tanh(u) + ripple * np.sin(3.0 * width * u)))

        return Hooks(axis=(drift,))

    return Draw(most / 3000.0, most, hooks, lambda a: f"{axis.letter} moves by {sign * a:.3g} m per rad")


MOTION_OFFSET = InjectionPlan("motion_offset", "bias that varies with the angle", "constant bias", motion_offset)
AXIS_MIGRATION = InjectionPlan(
    "axis_migration", "path that levels off and ripples", "parabola in the angle", axis_migration, placed=True
)
