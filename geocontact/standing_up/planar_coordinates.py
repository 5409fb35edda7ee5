"""Coordinates of the planar chain from the motion of a whole body in space, and the body's segments in that plane.

The plane is upright; its normal is the mean horizontal direction from the left hip to the right one, and x lies in it
forwards. Shank and thigh are the lines between the centres of their joints, the trunk is the line from the middle of
the hips to the mass centre of all that is no leg, arms included; the foot turns as its heaviest body does from where it
is with all coordinates at their default. Angles and ankles of both legs are averaged: the chain has one of each.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.model import Body, Multibody
from geocontact.standing_up.plate_places import BodySites

LEG_JOINTS = ("hip", "knee", "ankle")
UP = np.array([0.0, 1.0, 0.0])
Places = Float[np.ndarray, "t 3"]


@dataclass(frozen=True)
class BodyLeg:
    """Joints of one leg of a model."""

    hip: JointModel
    knee: JointModel
    ankle: JointModel


@dataclass(frozen=True, eq=False)
class PlanarMotion:
    """A motion in the plane.

    Parameters
    ----------
    q
        `chain.COORDINATES` [m, rad].
    forwards
        Unit vector of x in the frame of the ground.
    apart
        Right less left of each angle and of the ankle's place over time [rad, m]; empty for one leg.
    leaning
        Angle of each segment with the plane over time [rad], by leg and name.
    own
        Mass (of one leg), length, mass centre and radius of gyration of each segment [kg, m].
    """

    q: Float[np.ndarray, "t 6"]
    forwards: Float[np.ndarray, " 3"]
    apart: Mapping[str, Float[np.ndarray, " t"]]
    leaning: Mapping[str, Float[np.ndarray, " t"]]
    own: Mapping[str, Mapping[str, float]]

    @property
    def turn(self) -> Rotation:
        """Rotation of vectors of the ground's frame into that of the plane: x forwards, y up, z right."""
        return Rotation.from_matrix(np.stack([self.forwards, UP, np.cross(self.forwards, UP)]))


def planar_motion(
    model: Multibody, values: Float[np.ndarray, "t n"], legs: Mapping[str, BodyLeg], used: Sequence[str]
) -> PlanarMotion:
    """The motion of the legs that are used, about their mean; ValueError for hips that lie above each other.

    Parameters
    ----------
    values
        Coordinates of the model [rad, m].
    legs
        By side, right and left.
    """
    poses = model.poses(values)
    at = {side: {name: _centre(poses, getattr(leg, name)) for name in LEG_JOINTS} for side, leg in legs.items()}
    across = (at["right"]["hip"] - at["left"]["hip"]).mean(axis=0) * [1.0, 0.0, 1.0]
    if np.linalg.norm(across) < 1e-3:
        raise ValueError("the right hip is not beside the left one")
    forwards = np.cross(UP, across / np.linalg.norm(across))
    groups = _groups(model, legs)
    trunk = _mass_centre(poses, groups["trunk"]) - 0.5 * (at["right"]["hip"] + at["left"]["hip"])
    default = model.poses(np.array([[c.default for c in model.coordinates]]))
    leaning = {"trunk": _leaning(trunk, forwards)}
    turns: dict[str, dict[str, Float[np.ndarray, " t"]]] = {}
    for side in used:
        hip, knee, ankle = (at[side][name] for name in LEG_JOINTS)
        foot = max(groups[f"{side} foot"], key=lambda body: body.mass).name
        toes = _toes(poses, default, foot, legs)
        turns[side] = {
            "foot": np.arctan2(toes[:, 1], toes @ forwards),
            "shank": _turn(knee - ankle, forwards),
            "thigh": _turn(hip - knee, forwards),
            "foot_x": ankle @ forwards,
            "foot_y": ankle[:, 1],
        }
        leaning |= {f"{side} shank": _leaning(knee - ankle, forwards), f"{side} thigh": _leaning(hip - knee, forwards)}
    mean = {name: np.mean([turns[side][name] for side in used], axis=0) for name in turns[used[0]]}
    lean = _turn(trunk, forwards)
    joints = (mean["shank"] - mean["foot"], mean["thigh"] - mean["shank"], lean - mean["thigh"])
    q = np.column_stack([mean["foot_x"], mean["foot_y"], mean["foot"], *joints])
    apart = {name: turns["right"][name] - turns["left"][name] for name in mean} if len(used) == 2 else {}
    return PlanarMotion(q, forwards, apart, leaning, _own(poses, default, groups, legs, used, forwards))


def body_sites(
    model: Multibody, time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"], legs: Mapping[str, BodyLeg]
) -> BodySites:
    """Ankles, feet, hips and knees in the frame of the ground, for the plates under them; arguments as above."""
    poses, groups = model.poses(values), _groups(model, legs)
    default = model.poses(np.array([[c.default for c in model.coordinates]]))
    heaviest = {side: max(groups[f"{side} foot"], key=lambda body: body.mass).name for side in legs}
    hips, knees = (
        np.mean([_centre(poses, getattr(leg, name)) for leg in legs.values()], axis=0) for name in ("hip", "knee")
    )
    ankles = {side: _centre(poses, leg.ankle) for side, leg in legs.items()}
    toes = {side: _toes(poses, default, foot, legs) for side, foot in heaviest.items()}
    return BodySites(time, ankles, toes, hips, knees)


def _toes(
    poses: Mapping[str, RigidTransform], default: Mapping[str, RigidTransform], foot: str, legs: Mapping[str, BodyLeg]
) -> Places:
    """Unit vector that points forwards with all coordinates at their default, carried along by the foot."""
    ahead = default[foot].rotation.inv().apply(_forwards_at_rest(default, legs))[0]
    return np.asarray(poses[foot].rotation.apply(ahead))


def _centre(poses: Mapping[str, RigidTransform], joint: JointModel) -> Places:
    """Centre of a joint on its child."""
    return np.asarray(poses[joint.child].apply(joint.child_offset.translation))


def _turn(up: Places, forwards: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " t"]:
    """Turn of an upright line about z, to the back positive."""
    return np.asarray(np.arctan2(-(up @ forwards), up[:, 1]))


def _leaning(line: Places, forwards: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " t"]:
    across = np.cross(forwards, UP)
    return np.asarray(np.arcsin(line @ across / np.linalg.norm(line, axis=1)))


def _forwards_at_rest(default: Mapping[str, RigidTransform], legs: Mapping[str, BodyLeg]) -> Float[np.ndarray, "1 3"]:
    across = (_centre(default, legs["right"].hip) - _centre(default, legs["left"].hip)) * [1.0, 0.0, 1.0]
    return np.cross(UP, across / np.linalg.norm(across))


def _groups(model: Multibody, legs: Mapping[str, BodyLeg]) -> dict[str, list[Body]]:
    """Bodies of foot, shank and thigh by side, and all others as the trunk."""
    below: dict[str, set[str]] = {}
    for joint in reversed(model.joints):
        below[joint.child] = {joint.child}.union(*(below[j.child] for j in model.joints if j.parent == joint.child))
    found: dict[str, list[Body]] = {}
    taken: set[str] = set()
    for side, leg in legs.items():
        foot, shank, thigh = (below[joint.child] for joint in (leg.ankle, leg.knee, leg.hip))
        parts = {"foot": foot, "shank": shank - foot, "thigh": thigh - shank}
        found |= {f"{side} {name}": [body for body in model.bodies if body.name in of] for name, of in parts.items()}
        taken |= thigh
    return {**found, "trunk": [body for body in model.bodies if body.name not in taken]}


def _mass_centre(poses: Mapping[str, RigidTransform], bodies: Sequence[Body]) -> Places:
    mass = sum(body.mass for body in bodies)
    return np.asarray(sum(body.mass * poses[body.name].apply(body.centre) for body in bodies) / mass)


def _gyration(poses: Mapping[str, RigidTransform], bodies: Sequence[Body], forwards: Float[np.ndarray, " 3"]) -> float:
    """Radius about the plane's normal through the common mass centre [m], the mean over time."""
    across, middle = np.cross(forwards, UP), _mass_centre(poses, bodies)
    mass, square = sum(body.mass for body in bodies), np.zeros(len(middle))
    for body in bodies:
        off = poses[body.name].apply(body.centre) - middle
        own = poses[body.name].rotation.inv().apply(across)
        square += body.mass * ((off @ forwards) ** 2 + off[:, 1] ** 2)
        square += np.einsum("ti,ij,tj->t", own, body.inertia, own)
    return float(np.sqrt(square.mean() / mass))


def _own(
    poses: Mapping[str, RigidTransform],
    default: Mapping[str, RigidTransform],
    groups: Mapping[str, Sequence[Body]],
    legs: Mapping[str, BodyLeg],
    used: Sequence[str],
    forwards: Float[np.ndarray, " 3"],
) -> dict[str, dict[str, float]]:
    """Means over the legs that are used; feet as with all coordinates at their default.

    The trunk has what two such legs leave of the model's mass.
    """
    found: dict[str, list[dict[str, float]]] = {"foot": [], "shank": [], "thigh": []}
    rest = _forwards_at_rest(default, legs)[0]
    for side in used:
        hip, knee, ankle = (_centre(poses, getattr(legs[side], name)) for name in LEG_JOINTS)
        for name, low, high in (("shank", ankle, knee), ("thigh", knee, hip)):
            line, bodies = high - low, groups[f"{side} {name}"]
            length = np.linalg.norm(line, axis=1)
            centre = np.einsum("ti,ti->t", _mass_centre(poses, bodies) - low, line) / length
            found[name].append(_values(bodies, float(length.mean()), float(centre.mean()), poses, forwards))
        bodies = groups[f"{side} foot"]
        ahead = float((_mass_centre(default, bodies) - _centre(default, legs[side].ankle))[0] @ rest)
        foot = _values(bodies, 0.0, ahead, default, rest)
        found["foot"].append({name: value for name, value in foot.items() if name != "length"})
    own = {name: {key: float(np.mean([one[key] for one in of])) for key in of[0]} for name, of in found.items()}
    hips = 0.5 * sum(_centre(poses, leg.hip) for leg in legs.values())
    away = np.linalg.norm(_mass_centre(poses, groups["trunk"]) - hips, axis=1)
    trunk = _values(groups["trunk"], 0.0, float(away.mean()), poses, forwards)
    every = sum(body.mass for bodies in groups.values() for body in bodies)
    trunk["mass"] = every - 2.0 * sum(values["mass"] for values in own.values())
    return {**own, "trunk": {name: value for name, value in trunk.items() if name != "length"}}


def _values(
    bodies: Sequence[Body],
    length: float,
    centre: float,
    poses: Mapping[str, RigidTransform],
    forwards: Float[np.ndarray, " 3"],
) -> dict[str, float]:
    mass = sum(body.mass for body in bodies)
    return {"mass": mass, "length": length, "centre": centre, "gyration": _gyration(poses, bodies, forwards)}
