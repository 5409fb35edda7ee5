"""Constant bias of one input that the model uses: angle, marker height, pitch, contact area.

input → input + offset, of either sign. What only travels, as the foot's x, is not offered: only its rate enters, so a
bias of it is invisible. Of a strapped-on site the normal displacement is: a bias of its rotation is one of that, ρ
times as large.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_motion

RANK = 10.0
PLAUSIBLE = {"rad": 0.35, "m": 1.0}
"""Largest bias that a careful laboratory might have, by unit; of a length over its half-range.

A system says more of its own inputs (`Traits.plausible`, `System.bias`).
"""
BIASED = ("position", "displacement", "area")
"""Roles of inputs that a constant error of shows in."""


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
    """One candidate per input that the base uses and that a bias shows in."""
    used = [name for name in system.driving if system.role(name) in BIASED]
    most = {name: largest_bias(system, name) for name in used}
    return tuple(biased(system, name, system.unit(name), most[name]) for name in used if most[name] > 0.0)


def largest_bias(system: System, name: str) -> float:
    """In the input's unit; 0 where none is plausible, or nobody knows one."""
    unit = system.unit(name)
    relative = system.traits.plausible.get(name, PLAUSIBLE.get(unit, 0.0))
    per = 1.0 if unit == "rad" else system.scale.span.get(name, 1.0)
    return system.bias.get(name, relative * per)


MOTION_OFFSET = Effect(
    "motion_offset",
    "kinematics",
    offer,
    "marker placement and alignment errors: Della Croce et al. (2005) Gait Posture 21:226",
)
