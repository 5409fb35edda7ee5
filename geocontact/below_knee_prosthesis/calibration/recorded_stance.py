"""A recorded stance: where the foot was, what the plate showed, and how far both may be off."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
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
        Of the foot [m, rad], each constant over the stance.
    speed
        Of the foot along each axis [m/s]; along the floor from frame to frame (`slip`), upward constant.
    """

    force: float = 3.0
    couple: float = 1.0
    height: float = 0.5e-3
    pitch: float = np.radians(0.2)
    speed: float = 20e-3


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
        difference.
        """
        e = self.errors
        pressing = np.maximum(self.force[:, 1], 1.0)
        plate = np.column_stack([np.full((len(self.time), 3), e.force), e.couple / pressing / keel.keel.length])
        base = self.predicted(keel, self.solved(keel))
        square = plate**2
        for moved in self._moved():
            square += np.nan_to_num(moved.predicted(keel, moved.solved(keel)) - base) ** 2
        return np.asarray(np.sqrt(square))

    def _moved(self) -> list[RecordedStance]:
        """By one standard deviation of each error of the poses; pitch about the middle of the keel."""
        e = self.errors
        raised = RigidTransform.from_translation([0.0, e.height, 0.0]) * self.poses
        middle = np.array([0.11, 0.0, 0.0])
        turn = Rotation.from_euler("z", e.pitch)
        pitched = self.poses * RigidTransform.from_components(middle - turn.apply(middle), turn)
        rate = self.rate.copy()
        rate[:, 1, 3] += e.speed
        return [replace(self, poses=raised), replace(self, poses=pitched), replace(self, rate=rate)]
