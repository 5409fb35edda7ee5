"""Angles of joints in a Cardan or Euler sequence of choice, or as quaternions.

A sequence names the axes of the joint's frames in the order of the turns, each turned by the ones before it: ZXY is
flexion about z, adduction about the turned x, rotation about the long axis y of the other frame, as the ISB defines hip
and knee (Wu et al. 2002, J Biomech 35, 543-548; Grood & Suntay 1983). For the shoulder it has YXY, plane of elevation,
elevation and rotation, and YXZ for the clavicle's joints (Wu et al. 2005, J Biomech 38, 981-992); they are known by
their names. Right and left are written alike, as turns about the axes of the frames; coordinates of a model have the
clinical signs.

Where the second angle is near its end, 90 degrees of a sequence of three axes, 0 and 180 of one that ends on its first
axis, only the sum or difference of the first and third turn is defined: gimbal lock, which a quaternion has not.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.data.multibody.joint_angle_forms import JointAngleForm, TurnSequence
from geocontact.data.multibody.model import Multibody

ISB: TurnSequence = "ZXY"
ISB_OF_ARM: dict[str, TurnSequence] = {
    "shoulder": "YXY",
    "glenohumeral": "YXY",
    "acromial": "YXY",
    "thoracohumeral": "YXY",
    "humerothoracic": "YXY",
    "sternoclavicular": "YXZ",
    "acromioclavicular": "YXZ",
}
"""Sequences of the ISB that are not `ISB`, by what the joint's name has in it; acromial is OpenSim's shoulder."""
LOCKED = float(np.radians(0.1))
"""Distance of the second angle from its end [rad] within which first and third have no value."""
UNSURE = float(np.radians(10.0))
"""The same within which errors of the first and the third are six times those of the rotation and more: 1/sin."""


@dataclass(frozen=True, eq=False)
class JointAngles:
    """One joint over time.

    Parameters
    ----------
    columns
        Angles in the order of the turns, by axis [rad], continuous over time; of a quaternion w, x, y, z, continuous
        as well.
    lock
        Distance of the second angle from gimbal lock [rad]; infinite of a quaternion.
    """

    columns: dict[str, Float[np.ndarray, " t"]]
    lock: Float[np.ndarray, " t"]


def joint_rotations(model: Multibody, values: Float[np.ndarray, "t n"]) -> dict[str, Rotation]:
    """Turn of the child's joint frame in the parent's over time, of every joint that turns about two axes or three."""
    q = {c.name: column for c, column in zip(model.coordinates, values.T, strict=True)}
    found = {}
    for joint in model.joints:
        if sum(bool(axis.coordinates) for axis in joint.axes[:3]) > 1:
            turned = joint.pose(q, len(values)).rotation
            found[joint.name] = joint.parent_offset.rotation.inv() * turned * joint.child_offset.rotation
    return found


def isb_of(joint: str) -> TurnSequence:
    """Sequence of the ISB for a joint of this name."""
    return next((own for part, own in ISB_OF_ARM.items() if part in joint.lower()), ISB)


def joint_angles(rotation: Rotation, form: JointAngleForm, joint: str = "") -> JointAngles:
    """Angles of a rotation over time, in the ISB's form by the joint's name; NaN for the first and third where they are
    not defined.
    """
    if form == "quaternion":
        four = np.atleast_2d(rotation.as_quat(scalar_first=True))
        four[four[:, 0] < 0.0] *= -1.0
        flips = np.where(np.einsum("ti,ti->t", four[1:], four[:-1]) < 0.0, -1.0, 1.0)
        four[1:] *= np.cumprod(flips)[:, None]
        return JointAngles(dict(zip("wxyz", four.T, strict=True)), np.full(len(four), np.inf))
    sequence: TurnSequence = isb_of(joint) if form == "ISB" else form
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Gimbal lock", UserWarning)
        three = np.atleast_2d(rotation.as_euler(sequence))
    middle = np.abs(three[:, 1])
    end = 0.5 * np.pi if len(set(sequence)) == 3 else 0.0
    lock = np.abs(middle - end) if end else np.minimum(middle, np.pi - middle)
    three[lock < LOCKED, ::2] = np.nan
    names = [f"{place} {axis.lower()}" for place, axis in zip(("first", "second", "third"), sequence, strict=True)]
    return JointAngles({name: _continuous(column) for name, column in zip(names, three.T, strict=True)}, lock)


def _continuous(angle: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Without jumps of a whole turn, over gaps as well."""
    found, there = angle.copy(), np.isfinite(angle)
    found[there] = np.unwrap(angle[there])
    return found
