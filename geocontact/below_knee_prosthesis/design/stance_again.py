"""A stance as it would have been recorded with other errors of markers and plate: Monte Carlo on kinematics."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.calibration.stance_from_markers import hip_centres, stance_from_markers
from geocontact.below_knee_prosthesis.design.foot_task import FootTask, foot_task
from geocontact.below_knee_prosthesis.from_markers.standing import standing_leg
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.model.foot_offset import AS_STOOD, MIDDLE, FootOffset
from geocontact.below_knee_prosthesis.model.leg import Leg, Person
from geocontact.below_knee_prosthesis.stance_errors import PlateStance
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories

SLOW = 0.1
"""s; over which the slow half of a marker's error changes."""


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
        hip = hip_centres(self.walking, leg, stance.time, self.cutoff, self.gap_limit)
        return foot_task(replace(stance, poses=poses), hip, leg, self.keel, self.below)


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
        standing=_moved(trial.standing, errors.marker, rng),
        walking=_moved(trial.walking, errors.marker, rng),
        plate=PlateStance(plate.time, force, plate.centre),
    )
    return moved.task(errors.pitch * rng.standard_normal())


def _moved(seen: MarkerTrajectories, sd: float, rng: np.random.Generator) -> MarkerTrajectories:
    """With an error on every marker."""
    shape = seen.positions.shape
    step = float(np.median(np.diff(seen.time))) if len(seen.time) > 1 else SLOW
    slow = gaussian_filter1d(rng.standard_normal(shape), SLOW / step, axis=0, mode="wrap")
    slow /= max(float(slow.std()), 1e-12)
    error = np.sqrt(0.5) * sd * (slow + rng.standard_normal(shape))
    return replace(seen, positions=seen.positions + error)
