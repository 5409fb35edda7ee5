"""Play between what is measured of a motion and what follows it: hysteresis that does not depend on rate.

The input u is replaced by p, which rests until u has crossed the play: u - w/2 <= p <= u + w/2, w >= 0 its width (the
play operator of Krasnosel'skii & Pokrovskii). Its rate and acceleration are those of u where it is carried along, else
0. The shape `start` in -1..1 is where in the play a trial begins: p = u - start w/2. A model with a motion of its own
has none: its masses would have to be caught up with at a finite rate, which this law does not say how.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.history import with_play
from geocontact.chain.links import Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_motion

RANK = 15.0
MOVED = ("position", "displacement")
"""Roles of inputs that may have play."""


def loose(system: System, name: str) -> Candidate:
    """Play of one input."""
    row, span = system.inputs.index(name), system.scale.span.get(name, 1.0)
    width = Parameter(f"play.{name}.width", system.unit(name), 0.1 * span, 0.0, span)
    start = Parameter(f"play.{name}.start", "-", 0.0, -1.0, 1.0)

    def change(movement: DifferentiatedInputs, _: DifferentiatedInputs, values: Values) -> DifferentiatedInputs:
        if values[width.name] == 0.0:
            return movement
        own, carried = with_play(movement.position[row], values[width.name], values[start.name])
        position, rate, acceleration = (
            each.copy() for each in (movement.position, movement.rate, movement.acceleration)
        )
        position[row] = own
        rate[row] *= carried
        acceleration[row] *= carried
        return replace(movement, position=position, rate=rate, acceleration=acceleration)

    link = with_motion(Modifier(f"play.{name}", RANK, change, apart=True))
    others = ({width.name: 0.4 * span},)
    return Candidate("play", name, "kinematics", (width, start), link, {width.name: 0.0}, others, channel=name)


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per input that the base uses and that has a place; none for a model with a motion of its own."""
    if system.dynamic:
        return ()
    used = [name for name in system.driving if system.role(name) in MOVED]
    return tuple(loose(system, name) for name in used if np.isfinite(system.scale.span.get(name, np.nan)))


PLAY = Effect(
    "play",
    "kinematics",
    offer,
    "Krasnosel'skii & Pokrovskii (1989) Systems with Hysteresis; Nordin & Gutman (2002) Automatica 38:1633",
)
