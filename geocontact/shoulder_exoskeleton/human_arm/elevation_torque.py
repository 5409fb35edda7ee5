"""Torque with which the shoulder raises its arm: Newton and Euler of three slender segments, a tool and a push.

Segments are rigid and symmetric about their long axes, whose spin two markers do not show; the moment of inertia across
is the mean of de Leva's sagittal and transverse ones. With u the direction of a segment, its angular momentum about the
mass centre is I u × u'. The shoulder joint may move: everything is in an inertial frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline

from geocontact.data.body_segments import SEGMENTS, Sex
from geocontact.shoulder_exoskeleton.human_arm.arm_track import ArmTrack, smoothed
from geocontact.shoulder_exoskeleton.human_arm.hand_load import HandLoad

Places = Float[np.ndarray, "t 3"]
SPLINE = 5
"""Degree of the splines that are differentiated twice."""
CUTOFF = 6.0
"""Hz, of the low-pass before; usual for human motion (Winter 2009, sec. 3.4)."""


@dataclass(frozen=True)
class ElevationTorque:
    """Torque of one shoulder, positive where it raises the arm [N m], in parts that add up.

    Parameters
    ----------
    weight
        Against the arm's own weight.
    motion
        For the arm's acceleration.
    tool
        Against the tool's weight, and for its acceleration.
    push
        For the force on the work.
    """

    time: Float[np.ndarray, " t"]
    weight: Float[np.ndarray, " t"]
    motion: Float[np.ndarray, " t"]
    tool: Float[np.ndarray, " t"]
    push: Float[np.ndarray, " t"]

    @property
    def total(self) -> Float[np.ndarray, " t"]:
        """All of it."""
        return np.asarray(self.weight + self.motion + self.tool + self.push)


def elevation_torque(
    track: ArmTrack,
    load: HandLoad,
    *,
    mass: float,
    sex: Sex,
    gravity: Float[np.ndarray, " 3"],
    cutoff: float | None = CUTOFF,
) -> ElevationTorque:
    """Torque of the shoulder without any support.

    Parameters
    ----------
    mass
        Of the whole body [kg]; lengths of the segments are those between the joints, in the mean over the track.
    gravity
        In the track's frame [m/s²].
    cutoff
        Of the zero-lag low-pass on the joints [Hz]; None: none.
    """
    joints = track if cutoff is None else smoothed(track, cutoff)
    axis = joints.raising()
    ends = {
        "upper_arm": (joints.shoulder, joints.elbow),
        "forearm": (joints.elbow, joints.wrist),
        "hand": (joints.wrist, joints.hand),
    }
    weight, motion = np.zeros_like(axis), np.zeros_like(axis)
    for name, (near, far) in ends.items():
        segment = SEGMENTS[sex][name]
        own = segment.mass * mass
        along = far - near
        length = float(np.linalg.norm(along, axis=1).mean())
        sagittal, transverse, _ = segment.moments(own, length)
        centre = near + segment.centre * along
        unit = along / np.linalg.norm(along, axis=1, keepdims=True)
        arm = centre - joints.shoulder
        weight += np.cross(arm, -own * gravity)
        motion += np.cross(arm, own * second_derivative(joints.time, centre))
        motion += 0.5 * (sagittal + transverse) * np.cross(unit, second_derivative(joints.time, unit))
    reach = joints.hand - joints.shoulder
    tool = np.cross(reach, load.mass * (second_derivative(joints.time, joints.hand) - gravity))
    push = np.cross(reach, load.force)
    parts = (np.einsum("ti,ti->t", axis, each) for each in (weight, motion, tool, push))
    return ElevationTorque(joints.time, *parts)


def second_derivative(time: Float[np.ndarray, " t"], values: Places) -> Places:
    """By a spline through all values."""
    return np.asarray(make_interp_spline(time, values, k=SPLINE).derivative(2)(time))
