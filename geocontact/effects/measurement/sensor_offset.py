"""A measured output shifted by a constant.

output → output + o, of either sign, up to the largest value measured. A constant has no shape.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_sensor

RANK = 40.0


def shifted(system: System, name: str) -> Candidate:
    """Offset of one channel."""
    hit = np.array([name == other for other in system.outputs])
    most = system.scale.of(name)
    offset = Parameter(f"sensor_offset.{name}.offset", system.unit(name), 0.02 * most, -most, most)

    def change(outputs: Channels, _: DifferentiatedInputs, values: Values) -> Channels:
        return outputs + values[offset.name] * hit

    link = with_sensor(Modifier(f"sensor_offset.{name}", RANK, change, apart=True))
    return Candidate("sensor_offset", name, "sensor", (offset,), link, {offset.name: 0.0}, channel=name)


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per output."""
    return tuple(shifted(system, name) for name in system.outputs)


SENSOR_OFFSET = Effect("sensor_offset", "sensor", offer, "zero error of a sensor")
