"""An amplifier that compresses towards rails which are not alike, and is slow to recover.

planted:   c(y) = q + r (y - q) + (1 - r) (L - q) tanh((y - q)/(L - q)) beyond a knee q = 0.75..0.88 L, r = 0.06..0.12;
           of what is cut off, y - c(y), a share of 0.25..0.6 follows with a lag
candidate: y (1 + |y/L|^(1/s))^(-s), s <= 0.3, alike on both sides, at once
"""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.effects.mechanical.relaxation import settled
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Values
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes

LAG = {
    "elbow": (0.05, 0.12),
    "foot": (0.008, 0.014),
    "shoulder": (0.08, 0.14),
    "knee": (0.05, 0.07),
    "sit_to_stand": (0.05, 0.09),
}
"""Range of the recovery time [s]."""


def compressed(y: Values, rail: float, knee: float, give: float) -> Values:
    """y below `knee` rail, towards `rail` above."""
    begin = knee * rail
    room = max(rail - begin, 1e-12)
    beyond = y - begin
    return np.where(y > begin, begin + give * beyond + (1.0 - give) * room * np.tanh(beyond / room), y)


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: how far the rail lies below the largest output, as a share of it [-]."""
    names = tuple(scale.output)
    row = int(rng.choice([0, 1, 1])) if scale.system == "foot" else scale.load(rng)
    most = scale.output[names[row]]
    knee, other, give = rng.uniform(0.75, 0.88), rng.uniform(1.0, 1.3), rng.uniform(0.06, 0.12)
    slow = rng.uniform(*((0.25, 0.4) if scale.system == "elbow" else (0.45, 0.6)))
    lag = rng.uniform(*LAG[scale.system])

    def hooks(cut: float) -> Hooks:
        rail = (1.0 - cut) * most / (0.5 + 0.5 * knee)

        def limited(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            cut_off = outputs[row] + compressed(-compressed(outputs[row], rail, knee, give), other * rail, knee, give)
            late = settled(cut_off[:, None], float(course.time[1] - course.time[0]), lag)[:, 0]
            out[row] = outputs[row] - (1.0 - slow) * cut_off - slow * late
            return out

        return Hooks(sensor=((60.0, limited),))

    def words(cut: float) -> str:
        return f"{names[row]} is compressed from {(1.0 - cut) * most * knee / (0.5 + 0.5 * knee):.3g} on"

    return Draw(0.002, 0.6, hooks, words, names[row])


SATURATION = InjectionPlan(
    "saturation",
    ALL,
    "soft knee, uneven rails, slow recovery",
    "rounded symmetric clip",
    draw,
)
