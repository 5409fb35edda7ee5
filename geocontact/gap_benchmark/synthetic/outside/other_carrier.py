"""Something else carries load over a part of the motion: a cable that snaps over at the elbow, the arch of the foot, a
plica that pops over the condyle of a knee.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: load [N]. Foot: around the middle of stance, at a place of the sole. Else around an angle."""
    if scale.system == "knee":
        return popping(rng, scale)
    angle, wide = scale.middle + rng.uniform(-0.4, 0.4), rng.uniform(0.06, 0.15)
    at, spell, place = rng.uniform(0.35, 0.6), rng.uniform(0.05, 0.1), rng.uniform(0.06, 0.12)

    def hooks(size: float) -> Hooks:
        def snap(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            return np.asarray(size * np.exp(-(((course.position[0] - angle) / wide) ** 2)))[None]

        def arch(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            more = size * np.exp(-(((course.time / course.duration - at) / spell) ** 2))
            vertical = np.maximum(outputs[1] + more, 1.0)
            out[2] = (outputs[2] * outputs[1] + more * place) / vertical
            out[1] = outputs[1] + more
            return out

        return Hooks(sensor=((1.0, arch),)) if scale.system == "foot" else Hooks(load=(snap,))

    where = f"around {angle:.2g} rad" if scale.system == "elbow" else f"around {at:.0%} of stance"
    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda a: f"something else carries {a:.3g} N {where}")


def popping(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: load [N] of one side while flexion passes an angle, whichever way."""
    row = scale.load(rng)
    angle, wide = scale.middle + scale.span * rng.uniform(-0.5, 0.5), scale.span * rng.uniform(0.12, 0.3)
    name = tuple(scale.output)[row]

    def hooks(size: float) -> Hooks:
        def pop(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            added = np.zeros((len(scale.output), len(course.time)))
            added[row] = size * np.exp(-(((course.position[0] - angle) / wide) ** 2))
            return added

        return Hooks(load=(pop,))

    words = f"more in {name} while flexion passes {angle:.2g} rad"
    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda a: f"a plica pops over, {a:.3g} N {words}")


OTHER_CARRIER = InjectionPlan("other_carrier", ("elbow", "foot", "knee"), "load carried elsewhere", "", draw)
