"""One input is biased, by more at one end of its range than at the other: soft tissue.

planted:   recorded + o (1 + e sin((q - middle)/w)), e = 0.2..0.3, q the angle (elbow) or the pitch (foot)
candidate: recorded + o
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.gap.benchmark.planted.course import Course
from geocontact.gap.benchmark.planted.hooks import Hooks
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale

MOST = {"beta": 0.3, "y": 0.004, "pitch": 0.06}
UNIT = {"beta": "rad", "y": "m", "pitch": "rad"}


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: bias [rad] or [m], of either sign."""
    name = "beta" if scale.system == "elbow" else str(rng.choice(["y", "pitch"]))
    row = {"beta": 0, "y": 1, "pitch": 2}[name]
    by = 0 if name == "beta" else 2
    bend = scale.departure * rng.uniform(0.2, 0.3)
    middle, width = (scale.middle, 0.5) if name == "beta" else (-0.1, 0.25)
    sign = rng.choice([-1.0, 1.0])

    def hooks(size: float) -> Hooks:
        def moved(course: Course) -> Course:
            angle = (course.position[by] - middle) / width
            s, c = np.sin(angle), np.cos(angle)
            turn, spin = course.rate[by] / width, course.acceleration[by] / width
            position, rate, acceleration = course.position.copy(), course.rate.copy(), course.acceleration.copy()
            position[row] += sign * size * (1.0 + bend * s)
            rate[row] += sign * size * bend * c * turn
            acceleration[row] += sign * size * bend * (c * spin - s * turn**2)
            return replace(course, position=position, rate=rate, acceleration=acceleration)

        return Hooks(motion=(moved,))

    def words(size: float) -> str:
        return f"{name} is off by {sign * size:.3g} {UNIT[name]}, a little more at one end of the range"

    return Draw(1e-4 * MOST[name], MOST[name], hooks, words, name)


MOTION_OFFSET = Plan("motion_offset", ("elbow", "foot"), "bias that varies with the angle", "constant bias", draw)
