"""Pelvis and prosthetic leg as bodies and joints, angles after the ISB.

Pelvis: rotation, obliquity (list), tilt, in this order (Baker 2001, Pelvic angles: a mathematically rigorous
definition, Gait Posture 13, 1-6). Hip: flexion, adduction, internal rotation (Wu et al. 2002, ISB recommendation on
definitions of joint coordinate system, J Biomech 35, 543-548, after Grood & Suntay 1983). Knee: flexion only, as in the
study, which holds its other two turns.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.on_tree import keel_bodies, posterior_part
from geocontact.below_knee_prosthesis.model.leg import Leg
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.joint_kinds import cardan, free, revolute, weld
from geocontact.data.multibody.model import GROUND, Body, Multibody

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
