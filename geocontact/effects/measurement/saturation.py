"""A measured channel clips at a level, on both sides.

output → output (1 + |output/L|^(1/s))^(-s): a clip at ±L for s = 0, the shape s rounds its knee. The amplitude is the
level L > 0 itself; at L = infinity nothing is clipped.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_sensor

RANK = 60.0
SHARPEST = 1e-3
"""Softness below which the knee is a corner."""


def clipped(value: Float[np.ndarray, " t"], level: float, softness: float) -> Float[np.ndarray, " t"]:
    """`value` within ±level."""
    if softness < SHARPEST or not np.isfinite(level):
        return np.asarray(np.clip(value, -level, level))
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = np.log(np.abs(value) / level) / softness
        return np.asarray(value * np.exp(-softness * np.logaddexp(0.0, excess)))


def saturated(system: System, name: str) -> Candidate:
    """Clip of one channel."""
    column = system.outputs.index(name)
    most = system.scale.of(name)
    level = Parameter(f"saturation.{name}.level", system.unit(name), 0.95 * most, 0.05 * most, most)
    softness = Parameter(f"saturation.{name}.softness", "-", 0.03, 0.0, 0.15)

    def change(outputs: Channels, _: DifferentiatedInputs, values: Values) -> Channels:
        out = outputs.copy()
        out[:, column] = clipped(outputs[:, column], values[level.name], values[softness.name])
        return out

    link = with_sensor(Modifier(f"saturation.{name}", RANK, change, apart=True))
    others = ({level.name: 0.8 * most}, {level.name: 0.6 * most})
    neutral = {level.name: np.inf}
    return Candidate(
        "saturation", name, "sensor", (level, softness), link, neutral, others, channel=name, ceiling=level.name
    )


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per output."""
    return tuple(saturated(system, name) for name in system.outputs)


SATURATION = Effect(
    "saturation",
    "sensor",
    offer,
    "range of an amplifier or converter",
)
