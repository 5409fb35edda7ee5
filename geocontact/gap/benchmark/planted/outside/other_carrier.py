"""Something else carries load over a part of the motion: a cable that snaps over at the elbow, the arch of the foot."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap.benchmark.planted.course import Course
from geocontact.gap.benchmark.planted.hooks import Hooks, Outputs
from geocontact.gap.benchmark.planted.plan import Draw, Plan, Rng, Scale


def draw(rng: Rng, scale: Scale) -> Draw:
    """Amplitude: load [N]. Elbow: around an angle. Foot: around the middle of stance, at a place of the sole."""
    angle, wide = scale.middle + rng.uniform(-0.4, 0.4), rng.uniform(0.06, 0.15)
    at, spell, place = rng.uniform(0.35, 0.6), rng.uniform(0.05, 0.1), rng.uniform(0.06, 0.12)

    def hooks(size: float) -> Hooks:
        def snap(course: Course, _: Mapping[str, float]) -> Outputs:
            return np.asarray(size * np.exp(-(((course.position[0] - angle) / wide) ** 2)))[None]

        def arch(course: Course, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            more = size * np.exp(-(((course.time / course.duration - at) / spell) ** 2))
            vertical = np.maximum(outputs[1] + more, 1.0)
            out[2] = (outputs[2] * outputs[1] + more * place) / vertical
            out[1] = outputs[1] + more
            return out

        return Hooks(sensor=((1.0, arch),)) if scale.system == "foot" else Hooks(load=(snap,))

    where = f"around {angle:.2g} rad" if scale.system == "elbow" else f"around {at:.0%} of stance"
    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda a: f"something else carries {a:.3g} N {where}")


OTHER_CARRIER = Plan("other_carrier", ("elbow", "foot"), "load carried elsewhere", "", draw)
