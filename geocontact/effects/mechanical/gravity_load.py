"""Weight of a mass that the model does not know.

force += W sin(β + φ), at a joint moment += W sin(angle + φ): W of either sign (the sensor's sense is not stated), the
shape φ where the weight's direction and the zero of the angle do not agree. Shoulder: so at the recorded arm
("arm"), or a torque W sin(e + φ) that pulls the exoskeleton's arm down ("exo"), W >= 0.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, load_channels, with_balance, with_geometry

RANK = 10.0


def on_the_arm_that_is_moved(system: System) -> Candidate:
    """Weight on a body that the forces move: amplitude W, shape φ."""
    lever = {**system.known, **system.start}["L_h"]
    most = 2.0 * largest_load(system) * lever
    moment = Parameter("gravity_load.exo.moment", "N m", 0.025 * most, 0.0, most)
    phase = Parameter("gravity_load.exo.phase", "rad", 0.0, -0.5, 0.5)
    link = with_geometry({"gravity_load.moment": moment.name, "gravity_load.phase": phase.name})
    return Candidate("gravity_load", "exo", "load", (moment, phase), link, {moment.name: 0.0})


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate at the sensor, and one at the body that is moved where a system has one."""
    moved = system.geometry.slots.free("gravity_load.moment")
    here = at_the_sensor(system, "arm" if moved else "")
    return (*here, on_the_arm_that_is_moved(system)) if moved else here


def at_the_sensor(system: System, variant: str) -> tuple[Candidate, ...]:
    """Amplitude W, shape φ; none where there is no angle in space, or more than one load to add it to."""
    angles = [name for name in system.inputs if system.unit(name) == "rad" and system.role(name) == "position"]
    loads = load_channels(system)
    if not angles or len(loads) != 1:
        return ()
    force = system.scale.of(loads[0])
    name = f"gravity_load.{variant}" if variant else "gravity_load"
    weight = Parameter(f"{name}.weight", system.unit(loads[0]), 0.05 * force, -2.0 * force, 2.0 * force)
    phase = Parameter(f"{name}.phase", "rad", 0.0, -0.5, 0.5)
    row = system.inputs.index(angles[0])
    hit = np.array([name in loads for name in system.outputs])

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        load = values[weight.name] * np.sin(movement.position[row] + values[phase.name])
        return np.asarray(outputs + load[:, None] * hit)

    link = with_balance(Modifier(name, RANK, change))
    others = ({weight.name: -weight.start},)
    return (Candidate("gravity_load", variant, "load", (weight, phase), link, {weight.name: 0.0}, others),)


GRAVITY_LOAD = Effect("gravity_load", "load", offer, "statics of a segment about a horizontal axis")
