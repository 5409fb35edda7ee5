"""What a foot has to carry in a stance: turns of the socket, and the ground's force, frame by frame.

Taken from one recorded stance. What is not taken is the height of the foot: another foot carries the same load at
another height, and the person's leg, free upwards, gives way by that much.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.design.sagittal_leg import SagittalLeg, sagittal_leg
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.model.leg import Leg

LOADED = 0.08
"""Of body weight; frames with less are left out."""
EVERY = 2
"""Which frame of a recorded stance is taken: 100 Hz."""


@dataclass(frozen=True, eq=False)
class FootTask:
    """A stance as a foot has to carry it, in the frame of a right leg.

    Parameters
    ----------
    time
        Of the frames [s].
    pitch
        Of the keel's straight axis against the floor, toes up [rad].
    thigh
        Turn of the thigh in the same plane, from upright, to the left where x points to the right [rad].
    load, forward
        Of the ground on the foot, upwards and forwards along the foot [N].
    falling
        Speed at which the foot comes down at touch-down [m/s].
    ankle, bushing
        In the keel's frame [m].
    knee
        Origin of the shank in the keel's frame [m].
    leg
        Its masses and lengths.
    leg_length
        From the hip to the sole of a straight leg [m].
    weight
        Of the body [N].
    """

    time: Float[np.ndarray, " t"]
    pitch: Float[np.ndarray, " t"]
    thigh: Float[np.ndarray, " t"]
    load: Float[np.ndarray, " t"]
    forward: Float[np.ndarray, " t"]
    falling: float
    ankle: Float[np.ndarray, " 3"]
    bushing: Float[np.ndarray, " 3"]
    knee: Float[np.ndarray, " 3"]
    leg: SagittalLeg
    leg_length: float
    weight: float

    def aligned(self, angle: float) -> FootTask:
        """With the foot turned toes up against the socket by an angle [rad], about the ankle.

        The socket moves as it did, so that the foot turns in the ground's frame and the ankle keeps its place on it.
        """
        back = Rotation.from_euler("z", -angle)
        return replace(
            self,
            pitch=self.pitch + angle,
            bushing=self.ankle + back.apply(self.bushing - self.ankle),
            knee=self.ankle + back.apply(self.knee - self.ankle),
            leg=self.leg.aligned(angle, self.ankle[:2]),
        )


def foot_task(stance: RecordedStance, hip: Float[np.ndarray, "t 3"], leg: Leg, keel: Keel, below: float) -> FootTask:
    """From a recorded stance; ValueError where it carries nothing.

    Parameters
    ----------
    hip
        Its centre at the stance's times [m].
    below
        Height of the keel's axis above the sole [m].
    """
    loaded = np.flatnonzero(stance.force[:, 1] > LOADED * stance.weight)
    if not len(loaded):
        raise ValueError("the stance carries nothing")
    kept = np.arange(loaded[0], loaded[-1] + 1, EVERY)
    kept = kept[stance.force[kept, 1] > LOADED * stance.weight]
    axis = stance.poses.rotation[kept].apply([1.0, 0.0, 0.0])
    level = axis[:, ::2] / np.linalg.norm(axis[:, ::2], axis=1, keepdims=True)
    place = leg.turn.inv()
    up = hip[kept] - stance.poses[kept].apply(place.apply(-leg.keel))
    return FootTask(
        time=stance.time[kept],
        pitch=np.arcsin(np.clip(axis[:, 1], -1.0, 1.0)),
        thigh=np.arctan2(-np.einsum("ti,ti->t", level, up[:, ::2]), up[:, 1]),
        load=stance.force[kept, 1],
        forward=np.einsum("ti,ti->t", level, stance.force[kept, ::2]),
        falling=max(float(-stance.rate[int(loaded[0]), 1, 3]), 0.0),
        ankle=place.apply(leg.ankle - leg.keel),
        bushing=place.apply(leg.bushing - leg.keel),
        knee=place.apply(-leg.keel),
        leg=sagittal_leg(leg, keel),
        leg_length=leg.thigh + leg.shank + float(leg.ankle[1] - leg.keel[1]) + below,
        weight=stance.weight,
    )
