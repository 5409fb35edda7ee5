"""A push that only the sensor feels while a flag is on: somebody leans on a tool, the exoskeleton hardly moves.

force += P z, z the flag behind a first-order lag: z' = (event - z)/tau. P of either sign, up to twice the largest force
measured; the shape tau >= 0 is how fast a push is built up and let go.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.history import lagged
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, load_channels, with_balance

FLAG = "event"
RANK = 30.0
SLOWEST = 50.0
"""Largest tau, in samples."""


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude P, shape tau; none where there is no flag, or no single load that it could add to."""
    loads = load_channels(system)
    if FLAG not in system.inputs or len(loads) != 1:
        return ()
    most = largest_load(system)
    push = Parameter("event_load.push", system.unit(loads[0]), 0.1 * most, -2.0 * most, 2.0 * most)
    tau = Parameter("event_load.tau", "s", 2.0 * system.scale.step, 0.0, SLOWEST * system.scale.step)
    row, column = system.inputs.index(FLAG), system.outputs.index(loads[0])

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        flag = np.clip(movement.position[row], 0.0, 1.0)[:, None]
        out = outputs.copy()
        out[:, column] += values[push.name] * lagged(movement.time, flag, values[tau.name], 1.0)[:, 0]
        return out

    link = with_balance(Modifier("event_load", RANK, change))
    others = ({push.name: -push.start}, {push.name: push.start, tau.name: 20.0 * system.scale.step})
    return (Candidate("event_load", "", "load", (push, tau), link, {push.name: 0.0}, others),)


EVENT_LOAD = Effect(
    "event_load",
    "load",
    offer,
    "push force during screw-in, which the human-motion-driven model of a shoulder exoskeleton leaves out",
)
