"""Weight of a body whose centre does not lie on the link; at the shoulder it hangs on either arm.

planted:   W (sin(beta + phi) + e sin(3 beta)): a second mass that swings on its strap, e = 0.04..0.08,
           shoulder 2.5 times that; or W l (sin(e + phi) + e sin(3 e)) at the exoskeleton's hinge, l = 0.25 m
candidate: W sin(beta + phi); or at the hinge
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

LEVER = 0.25
"""Of what hangs on the exoskeleton's arm [m]."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: weight W [N], of either sense."""
    sign, phase = rng.choice([-1.0, 1.0]), rng.uniform(-0.15, 0.15)
    hanging = scale.departure * rng.uniform(0.04, 0.08) * (2.5 if scale.system == "shoulder" else 1.0)
    on_exo = scale.system == "shoulder" and (scale.departure < 1.0 or rng.random() < 0.3)
    if on_exo:
        sign, phase = 1.0, scale.departure * rng.uniform(-0.45, 0.45)

    def hooks(weight: float) -> Hooks:
        def pulled(p: Swing) -> Values:
            return np.asarray(weight * LEVER * (np.sin(p.angle + phase) + hanging * np.sin(3.0 * p.angle)))

        def hang(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            beta = course.position[0]
            added = np.zeros((len(scale.output), len(beta)))
            added[scale.loads[0]] = sign * weight * (np.sin(beta + phase) + hanging * np.sin(3.0 * beta))
            return added

        return Hooks(hinge=(pulled,)) if on_exo else Hooks(load=(hang,))

    where = " on the exoskeleton" if on_exo else ""
    variant = "" if scale.system == "elbow" else ("exo" if on_exo else "arm")
    words = f"unmodelled weight{where} of"
    return Draw(1e-3 * scale.force, 0.5 * scale.force, hooks, lambda w: f"{words} {sign * w:.3g} N", variant)


GRAVITY_LOAD = InjectionPlan("gravity_load", ("elbow", "shoulder"), "two masses, one swings", "sine of the angle", draw)
