"""Pelvis and both legs as bodies and joints: 28 coordinates and those of the keel.

6 of the pelvis, 3 of each hip, 3 of each knee, 6 of the socket, 3 of the intact ankle, 1 of its toes. The study counts
28 and does not list them; without a toe joint there are 27. Two of each knee's are held, as in the study.

Angles as in `model.leg_tree`; those of an intact ankle are flexion, inversion and rotation of the foot in the shank
(Wu et al. 2002, after Grood & Suntay 1983). The signs of both sides mean the same to the person.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.from_markers import MIRROR, mirrored_name
from geocontact.below_knee_prosthesis.keel.on_tree import keel_bodies, posterior_part
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.below_knee_prosthesis.leg_tree import FORWARD, GRAVITY, HIP, PELVIS, RIGHT, SOCKET, UP
from geocontact.data.multibody.joint import Coordinate, JointModel, TransformAxis, cardan, revolute, weld
from geocontact.data.multibody.model import GROUND, Body, Marker, Multibody

PLANE = np.diag(MIRROR)


def mirrored(model: Multibody) -> Multibody:
    """Every coordinate means the same in the image, but for those of joints on the ground.

    Those keep their axes, which are the laboratory's: their turns about x and y and their shift along z change sign.
    """
    bodies = tuple(Body(b.name, b.mass, b.centre * MIRROR, _turned(b.inertia)) for b in model.bodies)
    markers = tuple(replace(m, location=m.location * MIRROR) for m in model.markers)
    gravity = model.gravity * MIRROR
    return replace(model, bodies=bodies, joints=tuple(map(_joint, model.joints)), markers=markers, gravity=gravity)


def _joint(joint: JointModel) -> JointModel:
    joint = replace(joint, parent_offset=_pose(joint.parent_offset), child_offset=_pose(joint.child_offset))
    if joint.parent == GROUND:
        return joint
    axes = tuple(
        TransformAxis(axis.direction * MIRROR * (-1.0 if k < 3 else 1.0), axis.coordinates, axis.function)
        for k, axis in enumerate(joint.axes)
    )
    return replace(joint, axes=axes)


def _pose(pose: RigidTransform) -> RigidTransform:
    turn = Rotation.from_matrix(_turned(pose.rotation.as_matrix()))
    return RigidTransform.from_components(pose.translation * MIRROR, turn)


def _turned(matrix: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    return np.asarray(PLANE @ matrix @ PLANE)


KNEE = ("knee_flexion", "knee_adduction", "knee_rotation")
ANKLE = ("ankle_flexion", "ankle_inversion", "ankle_rotation")
"""Ankle of the intact leg; flexion lifts the foot."""
TOES = "toe_extension"
HELD = KNEE[1:]
"""Coordinates of both knees; they stay at zero."""
BODIES = {
    "thigh": "femur",
    "shank": "tibia",
    "foot": "calcn",
    "intact_thigh": "femur",
    "intact_shank": "tibia",
    "intact_foot": "calcn",
    "intact_toes": "toes",
}
"""What OpenSim's models call them; an ending of the side follows."""


def amputee_tree(amputee: Amputee, side: Side = "right", *, held: bool = False) -> Multibody:
    """The model of a person whose prosthesis is on that side, names ending in _r and _l.

    Parameters
    ----------
    held
        Whether socket and keel are held as well: for what markers alone are to tell.
    """
    own, other = ("_r", "_l") if side == "right" else ("_l", "_r")
    keel = amputee.foot.keel
    X_SB = amputee.prosthetic.X_SB
    below = keel_bodies(keel, f"calcn{own}", RigidTransform.identity(), ending=own)
    foot, toes = amputee.intact.foot_bodies()
    bodies = (
        Body("pelvis", *amputee.pelvis_body()),
        Body(f"femur{own}", *amputee.prosthetic.thigh_body()),
        Body(f"tibia{own}", *amputee.prosthetic.residual_body()),
        Body(f"socket{own}", *amputee.prosthetic.prosthesis_body()),
        Body(f"calcn{own}", *posterior_part(keel)),
        *below[0],
        Body(f"femur{other}", *amputee.intact.thigh_body()),
        Body(f"tibia{other}", *amputee.intact.shank_body()),
        Body(f"calcn{other}", *foot),
        Body(f"toes{other}", *toes),
    )
    joints = (*_prosthetic_joints(amputee, own), *below[1], *_intact_joints(amputee, other))
    markers = []
    for m in amputee.prosthetic.markers:
        place = X_SB.inv().apply(m.location) if m.body == "shank" else m.location
        body = {"pelvis": "pelvis", "shank": f"socket{own}"}.get(m.body, f"femur{own}")
        markers.append(Marker(m.name, body, place))
    markers += [Marker(m.name, f"{BODIES[m.body]}{other}", m.location) for m in amputee.intact.markers]
    gravity = np.array([0.0, -GRAVITY, 0.0])
    model = Multibody("below_knee_amputee", bodies, joints, tuple(markers), gravity)
    if side == "left":
        named = tuple(replace(m, name=mirrored_name(m.name)) for m in model.markers)
        model = mirrored(replace(model, markers=named))
    still = [f"{name}{end}" for name in HELD for end in (own, other)]
    if held:
        still += [c.name for c in model.coordinates if c.name.startswith(("socket_", "keel_"))]
    return _locked(model, still)


def _prosthetic_joints(amputee: Amputee, end: str) -> tuple[JointModel, ...]:
    leg = amputee.prosthetic
    turns = list(zip(PELVIS[:3], (UP, FORWARD, RIGHT), strict=True))
    shifts = list(zip(PELVIS[3:], (FORWARD, UP, RIGHT), strict=True))
    axes = (FORWARD, UP, RIGHT)
    socket = [(f"{name}{end}", axis) for name, axis in zip(SOCKET, (*axes, *axes), strict=True)]
    return (
        cardan("pelvis", GROUND, "pelvis", turns, shifts),
        cardan(f"hip{end}", "pelvis", f"femur{end}", _three(HIP, end, RIGHT), at=_at(leg.hip)),
        cardan(f"knee{end}", f"femur{end}", f"tibia{end}", _three(KNEE, end, -RIGHT), at=_at(-leg.thigh * UP)),
        cardan(f"socket{end}", f"tibia{end}", f"socket{end}", socket[:3], socket[3:], at=leg.X_SB),
        weld(f"pylon{end}", f"socket{end}", f"calcn{end}", _at(leg.keel_place)),
    )


def _intact_joints(amputee: Amputee, end: str) -> tuple[JointModel, ...]:
    """A left leg: what is adduction and inward rotation turns the other way round there."""
    leg = amputee.intact
    hip, knee = _three(HIP, end, RIGHT, -1.0), _three(KNEE, end, -RIGHT, -1.0)
    ankle = _three(ANKLE, end, RIGHT, -1.0)
    toes = f"{TOES}{end}"
    return (
        cardan(f"hip{end}", "pelvis", f"femur{end}", hip, at=_at(leg.hip)),
        cardan(f"knee{end}", f"femur{end}", f"tibia{end}", knee, at=_at(-leg.thigh * UP)),
        cardan(f"ankle{end}", f"tibia{end}", f"calcn{end}", ankle, at=_at(leg.ankle)),
        revolute(toes, f"calcn{end}", f"toes{end}", leg.toe_axis, _at(leg.toe_joint)),
    )


def _three(names: tuple[str, ...], end: str, first: np.ndarray, side: float = 1.0) -> list[tuple[str, np.ndarray]]:
    axes = (first, side * FORWARD, side * UP)
    return [(f"{name}{end}", axis) for name, axis in zip(names, axes, strict=True)]


def _at(place: np.ndarray) -> RigidTransform:
    return RigidTransform.from_translation(place)


def _locked(model: Multibody, names: list[str]) -> Multibody:
    def of(c: Coordinate) -> Coordinate:
        return replace(c, locked=True) if c.name in names else c

    joints = tuple(replace(j, coordinates=tuple(of(c) for c in j.coordinates)) for j in model.joints)
    return replace(model, joints=joints)
