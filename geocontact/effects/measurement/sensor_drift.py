"""A measured channel drifts in time through a trial.

output → output + r T (1 - exp(-c t/T))/c, t from the start of the trial, T the longest trial: linear, r t, for c = 0;
the shape c >= 0 bends it, as a sensor that warms up or creeps does. r of either sign. Every trial starts anew.
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

RANK = 50.0


def drift(share: Float[np.ndarray, " t"], bend: float) -> Float[np.ndarray, " t"]:
    """(1 - exp(-bend share))/bend, its limit for bend = 0 being `share`."""
    if bend == 0.0:
        return share
    return np.asarray(-np.expm1(-bend * share) / bend)


def drifting(system: System, name: str) -> Candidate:
    """Drift of one channel."""
    hit = np.array([name == other for other in system.outputs])
    whole, most = system.scale.duration, system.scale.of(name) / system.scale.duration
    rate = Parameter(f"sensor_drift.{name}.rate", f"{system.unit(name)}/s", 0.02 * most, -2.0 * most, 2.0 * most)
    bend = Parameter(f"sensor_drift.{name}.bend", "-", 0.0, 0.0, 10.0)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        share = (movement.time - movement.time[0]) / whole
        by = values[rate.name] * whole * drift(share, values[bend.name])
        return np.asarray(outputs + by[:, None] * hit)

    link = with_sensor(Modifier(f"sensor_drift.{name}", RANK, change, apart=True))
    others = ({rate.name: -rate.start},)
    return Candidate("sensor_drift", name, "sensor", (rate, bend), link, {rate.name: 0.0}, others, channel=name)


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per output."""
    return tuple(drifting(system, name) for name in system.outputs)


SENSOR_DRIFT = Effect(
    "sensor_drift",
    "sensor",
    offer,
    "warm-up drift of strain-gauge sensors",
)
