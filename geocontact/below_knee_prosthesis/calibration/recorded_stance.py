"""A recorded stance: where the foot was, what the plate showed, and how far both may be off."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.below_knee_prosthesis.model.foot_offset import MIDDLE
from geocontact.below_knee_prosthesis.simulate import share_of_foot
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.centre_of_pressure import GROUND_POINT, centre_of_pressure

FLOOR = HalfSpace()
"""Level ground, y up."""
CHANNELS = ("forward", "upward", "sideways", "centre")
"""Force on the foot in the ground's frame [N], and centre of pressure from the heel as a share of the keel's length."""


@dataclass(frozen=True)
class Errors:
    """Standard deviations of what was recorded; those of the poses are invented for a marker laboratory.

    Parameters
    ----------
    force
        Of the plate [N].
    couple
        Of the plate about its surface [N m]: over the vertical force it is the error of the centre.
    height, pitch
        Of the foot [m, rad]: what is constant over the stance, and as much that is not. 0.5 degrees are what a foot may
        have stood beside flat, as a choice of the foot has it.
    speed
        Of the foot along each axis [m/s]; along the floor from frame to frame (`slip`), upward constant.
    """

    force: float = 3.0
    couple: float = 1.0
    height: float = 0.5e-3
    pitch: float = np.radians(0.5)
    speed: float = 20e-3

    @property
    def standing(self) -> float:
        """Of the height of the foot's middle [m]: a foot that did not stand flat stood on one of its ends."""
        return float(np.hypot(self.height, self.pitch * MIDDLE[0]))


@dataclass(frozen=True, eq=False)
class RecordedStance:
    """One stance on one plate, level, y up.

    Parameters
    ----------
    time, poses, rate
        Pose `X_GK` of the keel's straight frame, and its derivative.
    fulcrum
        [m].
    force
        Of the plate on the foot [N].
    centre
        Share of the keel's length from the heel; NaN where there is none.
    weight
        Of the body [N].
    """

    time: Float[np.ndarray, " t"]
    poses: RigidTransform
    rate: Float[np.ndarray, "t 4 4"]
    fulcrum: float
    force: Float[np.ndarray, "t 3"]
    centre: Float[np.ndarray, " t"]
    weight: float
    errors: Errors = Errors()

    @property
    def measured(self) -> Float[np.ndarray, "t c"]:
        """By `CHANNELS`."""
        return np.column_stack([self.force, self.centre])

    def solved(self, keel: QuasiStaticKeel) -> KeelMotion:
        """The keel without inertia along the poses."""
        return keel.solve(self.poses, FLOOR, rate=self.rate, time=self.time)

    def predicted(self, keel: QuasiStaticKeel, motion: KeelMotion) -> Float[np.ndarray, "t c"]:
        """The same channels of a model; the centre is NaN where nothing touches."""
        centre = centre_of_pressure(motion.loads, GROUND_POINT).centre
        return np.column_stack([motion.force, share_of_foot(self.poses, keel.keel.length, centre)])

    def noise(self, keel: QuasiStaticKeel) -> Float[np.ndarray, "t c"]:
        """Standard deviation of measured less predicted, were the model right.

        The plate's, and what errors of height, pitch and upward speed make of the predicted channels, each by one
        difference: what is constant of height and pitch is sought besides (`moved`), what changes is noise.
        """
        e = self.errors
        pressing = np.maximum(self.force[:, 1], 1.0)
        plate = np.column_stack([np.full((len(self.time), 3), e.force), e.couple / pressing / keel.keel.length])
        base = self.predicted(keel, self.solved(keel))
        square = plate**2
        rate = self.rate.copy()
        rate[:, 1, 3] += e.speed
        for other in (self.moved(e.standing, 0.0), self.moved(0.0, e.pitch), replace(self, rate=rate)):
            square += np.nan_to_num(other.predicted(keel, other.solved(keel)) - base) ** 2
        return np.asarray(np.sqrt(square))

    def moved(self, height: float, pitch: float) -> RecordedStance:
        """Raised by a height [m] and turned by a pitch [rad], the toes up, about `MIDDLE`."""
        raised = RigidTransform.from_translation([0.0, height, 0.0]) * self.poses
        turn = Rotation.from_euler("z", pitch)
        about = RigidTransform.from_components(MIDDLE - turn.apply(MIDDLE), turn)
        return replace(self, poses=raised * about)
