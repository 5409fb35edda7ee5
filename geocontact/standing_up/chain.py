"""Feet, shanks, thighs and trunk in the sagittal plane: six coordinates, both legs as one chain.

x points forwards, y up, turns are about z. Both legs move alike, so that their masses are added and the ground's force
is that of both feet. Masses, mass centres and radii of gyration are fractions of body mass and segment length for men
(de Leva (1996), Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters, J Biomech 29, 1223-1230); head, arms
and trunk are one rigid body, whose numbers are rounded from that table with the arms hanging.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.joint_kinds import prismatic, revolute
from geocontact.data.multibody.model import Body, Multibody

COORDINATES = ("foot_x", "foot_y", "foot_turn", "ankle", "knee", "hip")
TURNING = (False, False, True, True, True, True)
"""Which coordinates are angles."""
JOINTS = ("ankle", "knee", "hip")
GRAVITY = np.array([0.0, -9.81, 0.0])
X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class Subject:
    """Body mass [kg] and height [m]."""

    mass: float = 70.0
    height: float = 1.75


@dataclass(frozen=True)
class _Segment:
    """Mass (both sides), length, mass centre and radius of gyration, of body mass, height, length and length."""

    mass: float
    length: float
    centre: float
    gyration: float


FOOT = _Segment(2 * 0.0137, 0.1482, 0.20, 0.245)
SHANK = _Segment(2 * 0.0433, 0.2529, 1.0 - 0.4459, 0.249)
THIGH = _Segment(2 * 0.1416, 0.2425, 1.0 - 0.4095, 0.329)
TRUNK = _Segment(1.0 - 2 * (0.0137 + 0.0433 + 0.1416), 0.3465, 0.53, 0.44)
"""From the lower joint upwards; of the foot from the ankle forwards, of the trunk from the hip."""


def leg_chain(subject: Subject) -> Multibody:
    """The chain; with all coordinates at 0 it stands upright with the ankle at the ground's origin."""
    bodies = [Body("fore_aft", 0.0, np.zeros(3), np.zeros((3, 3))), Body("upwards", 0.0, np.zeros(3), np.zeros((3, 3)))]
    bodies.append(_body("foot", FOOT, subject, X, -0.05))
    joints = [
        prismatic("foot_x", "ground", "fore_aft", X),
        prismatic("foot_y", "fore_aft", "upwards", Y),
        revolute("foot_turn", "upwards", "foot", Z),
    ]
    parent, at = "foot", RigidTransform.identity()
    for name, joint, segment in (("shank", "ankle", SHANK), ("thigh", "knee", THIGH), ("trunk", "hip", TRUNK)):
        bodies.append(_body(name, segment, subject, Y, 0.0))
        joints.append(revolute(joint, parent, name, Z, at))
        parent, at = name, RigidTransform.from_translation([0.0, segment.length * subject.height, 0.0])
    return Multibody("sit to stand", tuple(bodies), tuple(joints), (), GRAVITY)


def _body(name: str, segment: _Segment, subject: Subject, along: np.ndarray, height: float) -> Body:
    mass, length = segment.mass * subject.mass, segment.length * subject.height
    inertia = mass * (segment.gyration * length) ** 2
    return Body(name, mass, along * segment.centre * length + Y * height, inertia * np.eye(3))
