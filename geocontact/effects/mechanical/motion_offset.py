"""Constant bias of one input that the model uses: angle, marker height, pitch, contact area.

input → input + offset, of either sign. The foot's x is not offered: only its rate enters, so a bias of it is invisible.
Of a strapped-on site the normal displacement is: a bias of its rotation is one of that, ρ times as large.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.chain.candidate import Candidate
from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Effect
from geocontact.chain.links import Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_motion

RANK = 10.0
PLAUSIBLE = {"rad": 0.35, "m": 1.0}
"""Largest bias that a careful laboratory might have, by unit; of a length over its half-range."""
USED = {
    "elbow": (("beta", "rad", 0.35),),
    "foot": (("y", "m", 0.16), ("pitch", "rad", 0.15)),
    "shoulder": (("arm", "rad", 0.35),),
    "knee": (("area_medial", "m^2", 0.8), ("area_lateral", "m^2", 0.8)),
    "sit_to_stand": tuple((f"{site}_normal", "m", 2.5) for site in ("pelvis", "thigh", "shank")),
}
"""Inputs by system, with their unit and the largest bias, of lengths and areas over their half-ranges; of other systems
every angle and length (`System.bias`)."""


def biased(system: System, name: str, unit: str, most: float) -> Candidate:
    """Bias of one input."""
    row = system.inputs.index(name)
    offset = Parameter(f"motion_offset.{name}.offset", unit, 0.05 * most, -most, most)

    def change(movement: DifferentiatedInputs, _: DifferentiatedInputs, values: Values) -> DifferentiatedInputs:
        bias = np.zeros((len(movement.inputs), 1))
        bias[row] = values[offset.name]
        return replace(movement, position=movement.position + bias)

    link = with_motion(Modifier(f"motion_offset.{name}", RANK, change, apart=True))
    others = ({offset.name: -offset.start},)
    return Candidate("motion_offset", name, "kinematics", (offset,), link, {offset.name: 0.0}, others, channel=name)


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per input that matters."""
    units = ((name, system.unit(name)) for name in system.inputs)
    used = USED.get(system.name, tuple((name, unit, PLAUSIBLE[unit]) for name, unit in units if unit in PLAUSIBLE))
    there = [(name, unit, most) for name, unit, most in used if name in system.inputs]
    per = {name: 1.0 if unit == "rad" else system.scale.span.get(name, 1.0) for name, unit, _ in there}
    return tuple(biased(system, name, unit, system.bias.get(name, most * per[name])) for name, unit, most in there)


MOTION_OFFSET = Effect(
    "motion_offset",
    "kinematics",
    ("elbow", "foot", "shoulder", "knee", "sit_to_stand"),
    offer,
    "marker placement and alignment errors: Della Croce et al. (2005) Gait Posture 21:226",
)
