"""Weight of a mass that the model does not know.

force += W sin(β + φ): W of either sign (the sensor's sense is not stated), the shape φ where the weight's direction and
the zero of the angle do not agree.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.movement import Movement
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_balance

RANK = 10.0


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude W, shape φ."""
    force = system.scale.of("force")
    weight = Parameter("gravity_load.weight", "N", 0.05 * force, -2.0 * force, 2.0 * force)
    phase = Parameter("gravity_load.phase", "rad", 0.0, -0.5, 0.5)
    row = system.inputs.index("beta")

    def change(outputs: Channels, movement: Movement, values: Values) -> Channels:
        load = values[weight.name] * np.sin(movement.position[row] + values[phase.name])
        return np.asarray(outputs + load[:, None])

    link = with_balance(Modifier("gravity_load", RANK, change))
    others = ({weight.name: -weight.start},)
    return (Candidate("gravity_load", "", "load", (weight, phase), link, {weight.name: 0.0}, others),)


GRAVITY_LOAD = Effect("gravity_load", "load", ("elbow",), offer, "statics of a segment about a horizontal axis")
