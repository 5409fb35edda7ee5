"""Pelvis and prosthetic leg as bodies and joints, angles after the ISB, and a recorded motion that drives a stance.

Pelvis: rotation, obliquity (list), tilt, in this order (Baker 2001, Pelvic angles: a mathematically rigorous
definition, Gait Posture 13, 1-6). Hip: flexion, adduction, internal rotation (Wu et al. 2002, ISB recommendation on
definitions of joint coordinate system, J Biomech 35, 543-548, after Grood & Suntay 1983). Knee: flexion only, as in the
study, which holds its other two turns.

Pelvis, thigh and residual limb turn as they were recorded, so that against the pelvis nothing above the socket is
free: they move along with its free place like one point mass, pushed besides by the inertia of their recorded motion
against it. That is exact, and leaves a much smaller tree to the equations (`stance_model`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.on_tree import keel_bodies, posterior_part
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.data.multibody.joint import JointModel, cardan, free, revolute, weld
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.recorded_inputs import SMOOTH, RecordedInputs, recorded_inputs

FORWARD, UP, RIGHT = np.eye(3)
PELVIS = ("pelvis_rotation", "pelvis_list", "pelvis_tilt", "pelvis_tx", "pelvis_ty", "pelvis_tz")
HIP = ("hip_flexion", "hip_adduction", "hip_rotation")
KNEE = ("knee_flexion",)
RECORDED = (*PELVIS, *HIP, *KNEE)
"""Coordinates that markers tell."""
SOCKET = tuple(f"socket_{kind}{axis}" for kind in "rt" for axis in "xyz")
"""Turns and shifts of the prosthesis against the residual limb, in the bushing's frame."""
GRAVITY = 9.80665


def recorded_tree(leg: Leg) -> Multibody:
    """Pelvis, thigh and shank with their markers and without masses: the socket does not give."""
    bodies = tuple(Body(name, 0.0, np.zeros(3), np.zeros((3, 3))) for name in ("pelvis", "thigh", "shank"))
    return Multibody("prosthetic leg", bodies, _upper_joints(leg), leg.markers, np.zeros(3))


def whole_tree(leg: Leg, keel: Keel) -> Multibody:
    """With masses, the socket's six directions, the foot and its keel; loads are not part of it."""
    joints, (bodies, below) = _upper_joints(leg), keel_bodies(keel, "foot", RigidTransform.identity(), name="keel")
    mass = keel.posterior_mass + keel.joints * keel.segment_mass
    ball = np.zeros((3, 3))
    upper = (
        Body("pelvis", leg.pelvis_mass(mass), np.zeros(3), ball),  # its turns are given, so that they need no inertia
        Body("thigh", *leg.thigh_body()),
        Body("shank", *leg.residual_body()),
        Body("socket", *leg.prosthesis_body()),
        Body("foot", *posterior_part(keel)),
    )
    socket = free("socket", "shank", "socket", leg.X_SB)
    foot = weld("foot", "socket", "foot", RigidTransform.from_translation(leg.keel_place))
    gravity = np.array([0.0, -GRAVITY, 0.0])
    return Multibody("prosthetic side", (*upper, *bodies), (*joints, socket, foot, *below), leg.markers, gravity)


def _upper_joints(leg: Leg) -> tuple[JointModel, ...]:
    """The thigh's frame has its origin in the hip, the shank's in the knee."""
    turns = list(zip(PELVIS[:3], (UP, FORWARD, RIGHT), strict=True))
    shifts = list(zip(PELVIS[3:], (FORWARD, UP, RIGHT), strict=True))
    hip = list(zip(HIP, (RIGHT, FORWARD, UP), strict=True))
    knee = RigidTransform.from_translation(np.array([0.0, -leg.thigh, 0.0]))
    return (
        cardan("pelvis", GROUND, "pelvis", turns, shifts),
        cardan("hip", "pelvis", "thigh", hip, at=RigidTransform.from_translation(leg.hip)),
        revolute("knee_flexion", "thigh", "shank", -RIGHT, knee),
    )


TURNS: Final = "XYZ"
"""Turns of the bushing's frame in the ground, as `joint_kinds.free` turns."""


@dataclass(frozen=True, eq=False)
class LegMotion:
    """Recorded coordinates of one leg, filtered, without gaps.

    Parameters
    ----------
    leg
        Whose motion it is.
    time
        [s], even steps.
    values
        Of `RECORDED` [rad, m]; x forward along the walk, y up from the floor.
    """

    leg: Leg
    time: Float[np.ndarray, " t"]
    values: Float[np.ndarray, "t 10"]

    def of(self, name: str) -> Float[np.ndarray, " t"]:
        """One coordinate."""
        return self.values[:, RECORDED.index(name)]

    def at(self, time: Float[np.ndarray, " f"]) -> Float[np.ndarray, "f 10"]:
        """All coordinates at other times [s], on splines of the degree that a simulation is driven with."""
        return np.asarray(make_interp_spline(self.time, self.values, k=SMOOTH)(time))

    def part(self, start: float, stop: float) -> LegMotion:
        """Frames between two times, one more on each side where there is one."""
        step = self.time[1] - self.time[0]
        kept = (self.time > start - step) & (self.time < stop + step)
        return LegMotion(self.leg, self.time[kept], self.values[kept])

    def place(self, axis: str, when: float) -> tuple[float, float]:
        """Place [m] and speed [m/s] of the pelvis along x, y or z at a time."""
        curve = make_interp_spline(self.time, self.of(PELVIS[3 + "xyz".index(axis)]), k=SMOOTH)
        return float(curve(when)), float(curve(when, 1))


def driving_inputs(motion: LegMotion, pushing: Float[np.ndarray, "t 3"]) -> RecordedInputs:
    """Inputs of the equations of a stance: the bushing's frame with its derivatives, forces on the pelvis.

    Parameters
    ----------
    pushing
        Of the other leg on the pelvis at the motion's times, in the ground's frame [N].

    The frame's turns are those in the ground, its shifts those from the pelvis' free place (x, y), and z in the ground.
    """
    tree = recorded_tree(motion.leg)
    poses = tree.poses(motion.values)
    frame = poses["shank"] * motion.leg.X_SB
    pelvis = poses["pelvis"].translation.copy()
    pelvis[:, 2] = 0.0
    turns = np.unwrap(frame.rotation.as_euler(TURNS), axis=0)
    bearing = recorded_inputs(motion.time, np.hstack([turns, frame.translation - pelvis]), derivatives=2)
    moment = np.zeros_like(pelvis)
    for name, (mass, centre, _) in (("thigh", motion.leg.thigh_body()), ("shank", motion.leg.residual_body())):
        moment += mass * (poses[name].apply(centre) - pelvis)
    inertia = make_interp_spline(motion.time, moment, k=SMOOTH)(motion.time, 2)
    return bearing.beside(recorded_inputs(motion.time, (pushing - inertia)[:, :2]))


def carried_mass(leg: Leg, keel: float) -> float:
    """Mass of all above the socket [kg]; `keel` is the keel's own mass."""
    return leg.pelvis_mass(keel) + leg.thigh_body()[0] + leg.residual_body()[0]
