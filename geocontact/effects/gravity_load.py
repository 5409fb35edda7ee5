"""Weight of a mass that the model does not know.

force += W sin(β + φ), at a joint moment += W sin(angle + φ): W of either sign (the sensor's sense is not stated), the
shape φ where the weight's direction and the zero of the angle do not agree.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.movement import Movement
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import load_channels, with_balance

RANK = 10.0


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude W, shape φ; none where there is no angle, or more than one load to add it to."""
    angles = [name for name in system.inputs if system.unit(name) == "rad"]
    loads = load_channels(system)
    if not angles or len(loads) != 1:
        return ()
    force = system.scale.of(loads[0])
    weight = Parameter("gravity_load.weight", system.unit(loads[0]), 0.05 * force, -2.0 * force, 2.0 * force)
    phase = Parameter("gravity_load.phase", "rad", 0.0, -0.5, 0.5)
    row = system.inputs.index(angles[0])
    hit = np.array([name in loads for name in system.outputs])

    def change(outputs: Channels, movement: Movement, values: Values) -> Channels:
        load = values[weight.name] * np.sin(movement.position[row] + values[phase.name])
        return np.asarray(outputs + load[:, None] * hit)

    link = with_balance(Modifier("gravity_load", RANK, change))
    others = ({weight.name: -weight.start},)
    return (Candidate("gravity_load", "", "load", (weight, phase), link, {weight.name: 0.0}, others),)


GRAVITY_LOAD = Effect("gravity_load", "load", ("elbow",), offer, "statics of a segment about a horizontal axis")
