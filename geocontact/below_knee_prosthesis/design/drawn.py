"""Draws of what is not known: recorded stance, markers, plate, sole, keel, and the error of the foot's map.

The count of spheres is a number of the model, not of the foot, and moves what a foot does by up to a tenth, for each
sole is fitted anew to the same compressions: feet are drawn with 24, 48 and 96 spheres in turn. Each foot is drawn once
and walked along several draws of the kinematics. Differences between settings are taken within a draw, so that what all
settings share falls out of them.

A drawn stance has its errors on top of those that the recording has already. What they do to an outcome on the average,
as noise that only ever adds to a path's bend, they have done twice then. So each draw counts with its mirror image
about the outcome of the recording itself on the same foot, which has the error that the recording has taken off.
Errors of the map against forward dynamics (`map_error`) come on top.

The map is quasi-static and bears the recorded load. Along the same turns of pelvis, hip and knee a simulated foot has
inertia and dampers: that is the map's own error, on the present foot, and every draw has it. On another foot than the
present one the load differs as well, since the pelvis is free: that grows with the logarithm of the keel's stiffness
over that of the present one. Bands of outcomes have both. What is best is sought with the recorded load, as the
responses of a person say, and has the first. Both were measured (`benchmarks/prosthesis/forward.py`); of the rate of
loading, knee, hip, metabolic proxy and of another alignment they were not.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.calibration.recorded_stance import body_poses, stance_from_markers
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.foot_map import FootMap
from geocontact.below_knee_prosthesis.design.foot_task import FootTask, foot_task
from geocontact.below_knee_prosthesis.design.knob import AIMS, JUDGED, Knob
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import standing_leg
from geocontact.below_knee_prosthesis.keel.foam import cut_finer
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import BY_ZONE, KeelSole
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg import AS_STOOD, MIDDLE, FootOffset, Leg, Person
from geocontact.below_knee_prosthesis.marker_draws import with_errors
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.loads.sphere_set import SphereSet


@dataclass(frozen=True, eq=False)
class RecordedTrial:
    """A standing and a walking trial with a plate, of a right leg; the foot's fulcrum and what the poses are read with.

    Parameters
    ----------
    below
        From the sole up to the keel's axis [m].
    cutoff
        Of a zero-lag low-pass of the markers [Hz]; None for none.
    offset
        Of the foot beside the standing trial.
    """

    standing: MarkerTrajectories
    walking: MarkerTrajectories
    plate: PlateStance
    person: Person
    keel: Keel
    fulcrum: float
    below: float
    cutoff: float | None
    gap_limit: float
    offset: FootOffset = AS_STOOD

    @property
    def leg(self) -> Leg:
        """By the standing trial, with the foot beside it; InputError where markers cannot tell it."""
        return standing_leg(self.standing, self.person, self.keel, self.below).with_foot(self.offset)

    def task(self, tilt: float = 0.0) -> FootTask:
        """What the foot carries; InputError where markers or plate cannot tell it.

        `tilt` is an error of the foot's pitch [rad], constant over the stance.
        """
        leg = self.leg
        stance = stance_from_markers(
            self.walking,
            leg,
            self.plate,
            self.fulcrum,
            self.keel.length,
            cutoff=self.cutoff,
            gap_limit=self.gap_limit,
        )
        turn = Rotation.from_euler("z", tilt)
        poses = stance.poses * RigidTransform.from_components(MIDDLE - turn.apply(MIDDLE), turn)
        seen = body_poses(self.walking, leg.markers, "pelvis", stance.time, self.cutoff, self.gap_limit)
        return foot_task(replace(stance, poses=poses), seen, leg, self.keel, self.below)


@dataclass(frozen=True)
class TrialErrors:
    """Standard deviations of what was recorded; all invented for a marker laboratory.

    Parameters
    ----------
    marker
        Of each coordinate of a marker [m], half of its variance from frame to frame and half slowly.
    pitch
        Of the foot's pitch, from how flat it stood [rad].
    force
        Of a sample of the plate [N].
    gain
        Of the plate's sensitivity [-].
    """

    marker: float = 0.5e-3
    pitch: float = np.radians(0.5)
    force: float = 3.0
    gain: float = 0.01


def task_again(trial: RecordedTrial, errors: TrialErrors, rng: np.random.Generator) -> FootTask:
    """One draw."""
    plate = trial.plate
    force = plate.force * (1.0 + errors.gain * rng.standard_normal())
    force = force + rng.normal(0.0, errors.force, force.shape)
    moved = replace(
        trial,
        standing=with_errors(trial.standing, errors.marker, rng),
        walking=with_errors(trial.walking, errors.marker, rng),
        plate=PlateStance(plate.time, force, plate.centre),
    )
    return moved.task(errors.pitch * rng.standard_normal())


OF_MAP: tuple[Aim, ...] = ("ankle_moment", "socket_moment", "energy", "radius", "loading_rate")
PEAK: Mapping[Aim, Aim] = {"ankle_mean": "ankle_moment", "socket_mean": "socket_moment"}
"""Outcomes that have an error of the map of their own, and means that have that of their peak."""


@dataclass(frozen=True)
class MapError:
    """Standard deviations of the logarithm of an outcome by the map over that by forward dynamics.

    Parameters
    ----------
    here
        On the present foot, by aim.
    away
        What the load of a keel that is e times as stiff adds, by aim; in proportion to the logarithm of the stiffness.
    """

    here: Mapping[Aim, float]
    away: Mapping[Aim, float]

    def factors(
        self, stiffness: Float[np.ndarray, " n"], rng: np.random.Generator
    ) -> tuple[Float[np.ndarray, " aims"], Float[np.ndarray, "n aims"]]:
        """A draw: of the map itself, and of the load at values with those logarithms of stiffness over the present one.

        Each is one error for all values.
        """
        here, away = (np.array([of.get(PEAK.get(aim, aim), 0.0) for aim in AIMS]) for of in (self.here, self.away))
        drawn = dict(zip(OF_MAP, rng.standard_normal((2, len(OF_MAP))).T, strict=True))
        one, other = np.array([drawn.get(PEAK.get(aim, aim), np.zeros(2)) for aim in AIMS]).T
        return np.exp(here * one), np.exp(stiffness[:, None] * away * other)


MEASURED = MapError(
    here={"ankle_moment": 0.017, "socket_moment": 0.18, "energy": 0.028, "radius": 0.025},
    away={"ankle_moment": 0.058, "socket_moment": 0.355, "energy": 0.126, "radius": 0.084},
)
"""Root mean squares of nine present feet, three persons at three settings, and of sixteen others they walk on.

The socket's peak is that of a foot that slaps down, whose dampers shift the load forwards: the map has none.
"""
NONE = MapError({}, {})


def without_map_error(aim: Aim) -> bool:
    """Whether no error of the map was measured for this aim, nor for the peak that it goes with."""
    return PEAK.get(aim, aim) not in MEASURED.here


def stiffer(knob: Knob, keel: Keel) -> Float[np.ndarray, " n"]:
    """Logarithm of the stiffness at the keel's tip of each value over that of the present one."""
    if knob.vary == "stiffness":
        return np.log(knob.settings / knob.present)
    if knob.vary == "alignment":
        return np.zeros(len(knob.settings))
    soft = np.array([keel.tip_compliance(float(fulcrum)) for fulcrum in (knob.present, *knob.settings)])
    return np.asarray(np.log(soft[0] / soft[1:]))


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
    """Draws of a sweep.

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
    """The foot with its spheres, twice and four times as many; the law of a zone is shared among them.

    The shipped foot has 24, 48 and 96, each fitted to its compressions; zones differ from the usual ones by the same
    factors in all of them. `count` is how many of these are wanted.
    """
    usual = vsf_foot()
    if not _same(foot, usual):
        return tuple(_split(foot, finer) for finer in FINER[:count])
    factor = _values(foot) / _values(usual)
    found = []
    for finer in FINER[:count]:
        base = vsf_foot(finer=finer)
        zones = ZoneParameters(base.sole, base.law)
        found.append(replace(base, law=zones.law(zones.values_of(base.law) * factor)))
    return tuple(found)


def _same(foot: VariableStiffnessFoot, usual: VariableStiffnessFoot) -> bool:
    """Whether keel and spheres are those of the shipped foot, whatever its law is."""
    near = np.isclose(foot.keel.bending, usual.keel.bending, rtol=1e-6)
    if foot.sole.foam is not None:
        return False
    alike = replace(foot.keel, bending=0.5, torsional=0.5) == replace(usual.keel, bending=0.5, torsional=0.5)
    spheres = foot.sole.spheres, usual.sole.spheres
    shape = spheres[0].zone == spheres[1].zone and np.allclose(spheres[0].centre, spheres[1].centre, atol=1e-9)
    return bool(near and alike and shape)


def _split(foot: VariableStiffnessFoot, finer: int) -> VariableStiffnessFoot:
    """Every sphere as `finer` ones along the foot, spread over half the way to its neighbours; foam cut finer."""
    if finer == 1:
        return foot
    if foot.sole.foam is not None:
        return cut_finer(foot, finer)
    spheres, law = foot.sole.spheres, foot.law
    rows = np.unique(spheres.centre[:, 0])
    if len(rows) < 2:
        return foot
    middles = 0.5 * (rows[1:] + rows[:-1])
    edges = np.concatenate([[2.0 * rows[0] - middles[0]], middles, [2.0 * rows[-1] - middles[-1]]])
    row = np.searchsorted(rows, spheres.centre[:, 0])
    share = (np.arange(finer) + 0.5) / finer
    centre = np.repeat(spheres.centre, finer, axis=0)
    centre[:, 0] = (edges[row, None] + share * (edges[row + 1] - edges[row])[:, None]).ravel()
    zone = tuple(name for name in spheres.zone for _ in range(finer))
    sole = KeelSole(
        SphereSet(centre, np.repeat(spheres.radius, finer), zone), tuple(foot.keel.segment_of(centre[:, 0]))
    )
    count = len(spheres)
    stiffness, damping, static, kinetic = (
        np.repeat(np.broadcast_to(getattr(law, name), count), finer) for name in BY_ZONE
    )
    shared = replace(law, stiffness=stiffness / finer, damping=damping / finer, static=static, kinetic=kinetic)
    return replace(foot, sole=sole, law=shared)


def _values(foot: VariableStiffnessFoot) -> Float[np.ndarray, " p"]:
    return ZoneParameters(foot.sole, foot.law).values_of(foot.law)


def drawn_foot(
    foot: VariableStiffnessFoot, sd: Float[np.ndarray, " p"], keel: float, rng: np.random.Generator
) -> VariableStiffnessFoot:
    """Another foot that the same knowledge allows."""
    zones = ZoneParameters(foot.sole, foot.law)
    factor = np.exp(np.clip(sd * rng.standard_normal(len(sd)), -zones.reach, zones.reach))
    bending = foot.keel.bending * float(np.exp(keel * rng.standard_normal()))
    return replace(foot, keel=replace(foot.keel, bending=bending), law=zones.law(zones.values_of(foot.law) * factor))


def _widest(tasks: list[FootTask]) -> FootTask:
    """Pitches and loads of all draws of a stance as one, so that one table serves them."""
    over_time = [each.name for each in fields(FootTask) if re.search(r'" ?t\b', str(each.type))]  # first axis of a hint
    curves: dict[str, Any] = {name: np.concatenate([getattr(each, name) for each in tasks]) for name in over_time}
    return replace(tasks[0], **curves)
