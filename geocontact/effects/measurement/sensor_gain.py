"""A measured output, or all force outputs of a device, scaled by a constant.

output → (1 + g) output, -0.8 <= g <= 2. A linear sensor has no shape.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import load_channels, with_sensor

RANK = 20.0


def scaled(system: System, variant: str, channels: tuple[str, ...]) -> Candidate:
    """One gain for some channels."""
    hit = np.array([name in channels for name in system.outputs])
    gain = Parameter(f"sensor_gain.{variant}.gain", "-", 0.05, -0.8, 2.0)

    def change(outputs: Channels, _: DifferentiatedInputs, values: Values) -> Channels:
        return outputs * (1.0 + values[gain.name] * hit)

    channel = channels[0] if len(channels) == 1 else ""
    link = with_sensor(Modifier(f"sensor_gain.{variant}", RANK, change, apart=True))
    return Candidate(
        "sensor_gain", variant, "sensor", (gain,), link, {gain.name: 0.0}, ({gain.name: -0.05},), channel=channel
    )


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per output, and one for all forces where there are several."""
    forces = load_channels(system)
    single = tuple(scaled(system, name, (name,)) for name in system.outputs)
    return (*single, scaled(system, "forces", forces)) if len(forces) > 1 else single


SENSOR_GAIN = Effect(
    "sensor_gain",
    "sensor",
    offer,
    "calibration error of a linear sensor",
)
