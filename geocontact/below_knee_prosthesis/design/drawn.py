"""Draws of what is not known: numbers of the sole, keel, count of spheres, markers, plate; what a sweep makes of each.

The count of spheres is a number of the model, not of the foot, and moves what a foot does by up to a tenth, for each
sole is fitted anew to the same compressions: feet are drawn with 24, 48 and 96 spheres in turn. Each foot is drawn once
and walked along several draws of the kinematics. Differences between settings are taken within a draw, so that what all
settings share falls out of them.

A drawn stance has its errors on top of those that the recording has already. What they do to an outcome on the average,
as noise that only ever adds to a path's bend, they have done twice then. So each draw counts with its mirror image
about the outcome of the recording itself on the same foot, which has the error that the recording has taken off.
Errors of the map against forward dynamics (`map_error`) come on top.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.foot_map import FootMap
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import AIMS, JUDGED, Knob
from geocontact.below_knee_prosthesis.design.map_error import MEASURED, MapError, stiffer
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot, vsf_foot

KEEL = 0.03
"""Standard deviation of the logarithm of EI, as compressions rounded to 1 N/mm leave it."""
FINER = (1, 2, 4)
"""Factors on the rows of spheres."""
FEWEST = 0.5
"""Share of the draws that must be left for a band."""


@dataclass(frozen=True, eq=False)
class Draws:
    """Outcomes of a sweep.

    Parameters
    ----------
    drawn
        Of each draw and of its mirror image, by response, value and aim, with the recorded load.
    free
        The same with the load that would follow from the foot.
    lost
        Draws in which the keel had no equilibrium, and which are left out.
    beside
        Of each of these and each further alignment, by response that is judged, value and aim.
    """

    drawn: Float[np.ndarray, "d responses n aims"]
    free: Float[np.ndarray, "d responses n aims"]
    lost: int
    beside: Float[np.ndarray, "d alignments judged n aims"]


def draws(
    knob: Knob,
    foot: VariableStiffnessFoot,
    recorded: FootTask,
    again: Callable[[np.random.Generator], FootTask],
    sd: Float[np.ndarray, " p"],
    *,
    feet: int,
    walks: int,
    seed: int = 0,
    keel: float = KEEL,
    model: MapError = MEASURED,
    step: Callable[[], None] = lambda: None,
    alignments: Sequence[float] = (),
) -> Draws:
    """Of a sweep.

    Parameters
    ----------
    alignments
        With which every value is tried as well [rad].
    recorded
        The stance as it was recorded.
    again
        A draw of the stance, as other errors of markers and plate would have shown it.
    sd
        Of the logarithms of the sole's numbers, in the order of `ZoneParameters`.
    feet, walks
        Drawn feet, and draws of the stance for each.
    model
        Errors of the map.

    ArithmeticError where more than half of the drawn feet have no equilibrium.
    """
    rng, family, lost = np.random.default_rng(seed), finer_feet(foot, min(feet, len(FINER))), 0
    stiffness, unsure = stiffer(knob, foot.keel), np.random.default_rng([seed, 1])
    found: list[Float[np.ndarray, "responses n aims"]] = []
    free: list[Float[np.ndarray, "responses n aims"]] = []
    beside: list[Float[np.ndarray, "alignments judged n aims"]] = []
    turned = [replace(knob, turned=angle) for angle in alignments]
    widest = max((knob, *turned), key=lambda each: float(np.abs(each.alignments).max()))
    for k in range(feet):
        other = drawn_foot(family[k % len(family)], sd, keel, rng)
        tasks = [recorded, *(again(rng) for _ in range(walks))]
        try:
            maps = widest.maps(other, _widest(tasks))
            here = _mirrored([knob.measured(maps, each) for each in tasks])
            there = _mirrored([_turned(turned, maps, each) for each in tasks])
        except ArithmeticError:
            lost += 1
        else:
            factors = [model.factors(stiffness, unsure) for _ in here]
            found += [each * by for each, (by, _) in zip(here, factors, strict=True)]
            free += [each * by * more for each, (by, more) in zip(here, factors, strict=True)]
            beside += [each * by for each, (by, _) in zip(there, factors, strict=True)]
        step()
    if lost > FEWEST * feet:
        raise ArithmeticError(f"{lost} of {feet} drawn feet have no equilibrium along the stance")
    return Draws(np.array(found), np.array(free), lost, np.array(beside))


def _turned(
    knobs: Sequence[Knob], maps: Sequence[FootMap], task: FootTask
) -> Float[np.ndarray, "alignments judged n aims"]:
    """Outcomes with each further alignment; there may be none."""
    if not knobs:
        return np.zeros((0, len(JUDGED), len(maps) - 1, len(AIMS)))
    return np.array([one.measured_still(maps, task) for one in knobs])


def _mirrored(of: list[Float[np.ndarray, ...]]) -> list[Float[np.ndarray, ...]]:
    """Outcomes of the draws, and their mirror images about that of the recording, which is the first."""
    return [each for one in of[1:] for each in (one, 2.0 * of[0] - one)]


def finer_feet(foot: VariableStiffnessFoot, count: int = len(FINER)) -> tuple[VariableStiffnessFoot, ...]:
    """The foot with 24, 48 and 96 spheres; zones differ from the usual ones by the same factors in all of them.

    `count` is how many of these are wanted.
    """
    usual = vsf_foot()
    factor = _values(foot) / _values(usual)
    found = []
    for finer in FINER[:count]:
        base = vsf_foot(finer=finer)
        zones = ZoneParameters(base.sole, base.law)
        found.append(VariableStiffnessFoot(base.keel, base.sole, zones.law(zones.values_of(base.law) * factor)))
    return tuple(found)


def _values(foot: VariableStiffnessFoot) -> Float[np.ndarray, " p"]:
    return ZoneParameters(foot.sole, foot.law).values_of(foot.law)


def drawn_foot(
    foot: VariableStiffnessFoot, sd: Float[np.ndarray, " p"], keel: float, rng: np.random.Generator
) -> VariableStiffnessFoot:
    """Another foot that the same knowledge allows."""
    zones = ZoneParameters(foot.sole, foot.law)
    factor = np.exp(np.clip(sd * rng.standard_normal(len(sd)), -zones.reach, zones.reach))
    bending = foot.keel.bending * float(np.exp(keel * rng.standard_normal()))
    return VariableStiffnessFoot(
        replace(foot.keel, bending=bending), foot.sole, zones.law(zones.values_of(foot.law) * factor)
    )


def _widest(tasks: list[FootTask]) -> FootTask:
    """Pitches and loads of all draws of a stance as one, so that one table serves them."""
    time, pitch, thigh, load, forward = (
        np.concatenate([getattr(each, name) for each in tasks])
        for name in ("time", "pitch", "thigh", "load", "forward")
    )
    return replace(tasks[0], time=time, pitch=pitch, thigh=thigh, load=load, forward=forward)
