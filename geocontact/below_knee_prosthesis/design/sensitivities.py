"""How far outcomes on the present foot hang on each number: what is chosen, known of the foot, recorded.

Central differences, one number at a time, all else as it is: a step of the choice, or one standard deviation of what
is not known. What is not known changes the foot that the stance was recorded on, so that the person answers to nothing;
the choice is answered to. The table of the foot is elastic and has the recorded force along the ground, so that damping
and friction of the sole move nothing in it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.drawn import KEEL, finer_feet
from geocontact.below_knee_prosthesis.design.foot_task import FootTask, Terrain
from geocontact.below_knee_prosthesis.design.knob import RESPONSES, Knob, Vary
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot

Unit = Literal["m", "rad", "-", "factor"]
UNITS: dict[Vary, Unit] = {"fulcrum": "m", "alignment": "rad", "stiffness": "-"}
RECORDED = "as recorded"
"""Response of the person, where the foot that the stance was recorded on is another one."""
STEPS: dict[Vary, float] = {"fulcrum": 0.010, "alignment": float(np.radians(1.0)), "stiffness": 0.1}
"""By which what is chosen is changed: m, rad, factor."""


@dataclass(frozen=True, eq=False)
class FootSensitivity:
    """Sensitivity of the outcomes to one number.

    Parameters
    ----------
    name, by, unit
        What is changed, by how much, and in what: m, rad, - or factor.
    change
        Of each outcome by aim, for each response of the person.
    """

    name: str
    by: float
    unit: Unit
    change: Mapping[str, Float[np.ndarray, " aims"]]


@dataclass(frozen=True)
class Unknown:
    """Standard deviations of what is not known: logarithms of the sole's numbers, pitch [rad], plate's gain [-]."""

    sole: Float[np.ndarray, " p"]
    pitch: float
    gain: float


def sensitivities(
    foot: VariableStiffnessFoot, task: FootTask, fulcrum: float, terrain: Terrain, unknown: Unknown
) -> tuple[FootSensitivity, ...]:
    """On the foot as it is; ArithmeticError as `foot_map`."""

    def at(other: VariableStiffnessFoot, carried: FootTask) -> Float[np.ndarray, " aims"]:
        one = Knob("fulcrum", np.array([fulcrum]), fulcrum, terrain)
        return np.asarray(one.measured_still(one.maps(other, carried), carried)[0, 0])

    found = [_of_choice(vary, foot, task, fulcrum, terrain) for vary in STEPS]
    found.append(_factor("bending of the keel", KEEL, lambda by: at(_bent(foot, by), task)))
    zones = ZoneParameters(foot.sole, foot.law)
    for k, (name, sd) in enumerate(zip(zones.names, unknown.sole, strict=True)):
        if name.startswith("stiffness."):
            ends = [at(_pressed(foot, zones, k, by), task) for by in (float(sd), -float(sd))]
            found.append(FootSensitivity(name, float(np.exp(sd)), "factor", {RECORDED: 0.5 * (ends[0] - ends[1])}))
    feet = finer_feet(foot, 2)
    few, more = (at(each, task) for each in feet)
    counts = [len(each.sole.spheres) for each in feet]
    words = f"{counts[1]} spheres in place of {counts[0]}"
    found.append(FootSensitivity(words, 2.0, "factor", {RECORDED: more - few}))
    turns = [at(foot, replace(task, pitch=task.pitch + by)) for by in (unknown.pitch, -unknown.pitch)]
    found.append(FootSensitivity("pitch", unknown.pitch, "rad", {RECORDED: 0.5 * (turns[0] - turns[1])}))
    loaded = np.log1p(unknown.gain)
    found.append(_factor("load", float(loaded), lambda by: at(foot, replace(task, load=np.exp(by) * task.load))))
    return tuple(found)


def _of_choice(
    vary: Vary, foot: VariableStiffnessFoot, task: FootTask, fulcrum: float, terrain: Terrain
) -> FootSensitivity:
    """A step up and down as far as the range lets it, scaled to the whole step."""
    step, present = STEPS[vary], Knob(vary, np.zeros(1), fulcrum).present
    ends = np.array([present - step, present + step])
    if vary == "fulcrum":
        ends = np.clip(ends, *foot.keel.range)
    knob = Knob(vary, ends, fulcrum, terrain)
    low, high = np.moveaxis(knob.measured(knob.maps(foot, task), task), 1, 0)
    change = (high - low) * step / float(ends[1] - ends[0])
    return FootSensitivity(vary, step, UNITS[vary], dict(zip(RESPONSES, change, strict=True)))


def _factor(name: str, by: float, outcome: Callable[[float], Float[np.ndarray, " aims"]]) -> FootSensitivity:
    """Factor of a number whose logarithm changes by that much."""
    return FootSensitivity(name, float(np.exp(by)), "factor", {RECORDED: 0.5 * (outcome(by) - outcome(-by))})


def _bent(foot: VariableStiffnessFoot, by: float) -> VariableStiffnessFoot:
    keel = replace(foot.keel, bending=float(np.exp(by)) * foot.keel.bending)
    return replace(foot, keel=keel)


def _pressed(foot: VariableStiffnessFoot, zones: ZoneParameters, k: int, by: float) -> VariableStiffnessFoot:
    values = zones.values_of(foot.law).copy()
    values[k] *= np.exp(by)
    return replace(foot, law=zones.law(values))
