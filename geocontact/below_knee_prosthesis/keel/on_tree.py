"""The keel as bodies, joints and forces of a tree, and the ground as its own frame sees it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.data.multibody.joint import JointModel, revolute
from geocontact.data.multibody.model import Body
from geocontact.dynamics.equations import LawState
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.sphere_contact import laws_of, sole_wrench, together
from geocontact.dynamics.tree import Tree
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Ground
from geocontact.loads.sphere_set import SoleLaw

if TYPE_CHECKING:
    from casadi import SX


@dataclass(frozen=True)
class Planes:
    """Under each sphere in each frame, or one for all: unit normal, and how far along it the plane lies [m]."""

    normal: Float[np.ndarray, "t n 3"]
    level: Float[np.ndarray, "t n"]


def planes_under(ground: Ground, centre: Float[np.ndarray, "t n 3"]) -> Planes:
    """That touch the ground where it is nearest to places."""
    near = ground.proximity(centre.reshape(-1, 3))
    normal = near.normal.reshape(centre.shape)
    return Planes(normal, np.einsum("tni,tni->tn", near.closest.reshape(centre.shape), normal))


def plane_under(ground: HalfSpace, poses: RigidTransform) -> Planes:
    """One for all spheres in each frame."""
    return planes_under(ground, poses.translation.reshape(-1, 1, 3))


@dataclass(frozen=True)
class InKeel:
    """Planes, motion and gravity as the keel's frame sees them, and the frame itself in the ground's."""

    planes: Float[np.ndarray, "t n four"]
    twists: Float[np.ndarray, "t six"]
    gravities: Float[np.ndarray, "t 3"]
    rotation: Float[np.ndarray, "t 3 3"]
    origin: Float[np.ndarray, "t 3"]
    upwards: Float[np.ndarray, "t m 3"]


def seen_by_keel(
    poses: RigidTransform,
    under: Planes,
    gravity: tuple[float, float, float],
    rate: Float[np.ndarray, "t 4 4"] | None,
    spheres: int,
) -> InKeel:
    """The ground for poses `X_GK`; gravity in the ground's frame [m/s²]; rates of the poses, None where nothing moves.

    One plane for all is turned once, then handed to each of the `spheres`.
    """
    matrices = poses.as_matrix().reshape(-1, 4, 4)
    R, origin = matrices[:, :3, :3], matrices[:, :3, 3]
    heights = np.einsum("ti,tni->tn", origin, under.normal) - under.level
    twists = np.zeros((len(R), 6))
    if rate is not None:
        turning = np.einsum("tji,tjk->tik", R, rate[:, :3, :3])
        turning = 0.5 * (turning - turning.swapaxes(1, 2))
        twists[:, :3] = turning[:, (2, 0, 1), (1, 2, 0)]
        twists[:, 3:] = np.einsum("tji,tj->ti", R, rate[:, :3, 3])
    planes = np.concatenate([np.einsum("tij,tni->tnj", R, under.normal), heights[..., None]], axis=2)
    gravities = np.ascontiguousarray(np.einsum("tij,i->tj", R, np.asarray(gravity, float)))
    planes = np.repeat(planes, spheres // planes.shape[1], axis=1)
    return InKeel(np.ascontiguousarray(planes), twists, gravities, R, origin, under.normal)


TORSION = "torsion"


def keel_bodies(
    keel: Keel, parent: str, X_PK: RigidTransform, *, name: str = "keel", ending: str = ""
) -> tuple[tuple[Body, ...], tuple[JointModel, ...]]:
    """Segments in front of the first joint, and their joints, to follow the parent's in a `Multibody`.

    Bodies, joints and coordinates are `name`_1 to `name`_n, behind `name`_torsion of a keel that twists. What lies
    behind the first joint is rigid: it is part of the parent, whose mass has to hold it (`posterior_part`).

    Parameters
    ----------
    X_PK
        Pose of the keel's frame in the parent.
    ending
        Of all these names, as that of a side.
    """
    forward, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    at = X_PK * RigidTransform.from_translation(keel.places[0] * forward)
    bodies, joints, before = [], [], parent
    if keel.twists:
        twisted = f"{name}_{TORSION}{ending}"
        bodies.append(Body(twisted, 0.0, np.zeros(3), np.zeros((3, 3))))
        joints.append(revolute(twisted, parent, twisted, forward, at))
        before, at = twisted, RigidTransform.identity()
    for k in range(1, keel.joints + 1):
        segment = f"{name}_{k}{ending}"
        bodies.append(Body(segment, *piece(keel, keel.pitch)))
        joints.append(revolute(segment, before, segment, up, at))
        before, at = segment, RigidTransform.from_translation(keel.pitch * forward)
    return tuple(bodies), tuple(joints)


def posterior_part(keel: Keel) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass [kg], centre in K [m] and inertia about it [kg m²] of the part behind the first joint."""
    return piece(keel, keel.posterior)


def piece(keel: Keel, long: float) -> tuple[float, np.ndarray, np.ndarray]:
    """The same of a piece of some length [m] in front of its frame's origin."""
    mass = keel.density * keel.width * keel.thickness * long
    squares = np.array([long, keel.thickness, keel.width]) ** 2
    return mass, np.array([0.5 * long, 0.0, 0.0]), mass / 12.0 * np.diag(squares.sum() - squares)


def coordinates(keel: Keel, *, name: str = "keel") -> list[str]:
    """Names in the tree's order."""
    return [*([f"{name}_{TORSION}"] if keel.twists else []), *(f"{name}_{k}" for k in range(1, keel.joints + 1))]


def joint_numbers(keel: Keel, fulcrum: float) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness [N m/rad] and damping [N m s/rad] in the order of `coordinates`."""
    stiffness, damping = keel.stiffness(fulcrum), keel.damping(fulcrum)
    if keel.twists:
        k, b = keel.torsion(fulcrum)
        return np.append(k, stiffness), np.append(b, damping)
    return stiffness, damping


def rubbing_numbers(keel: Keel, fulcrum: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Friction over the angle's size [N m/rad] and at any angle [N m], and the turn over which both build up [rad].

    None in torsion.
    """
    size, held = keel.hysteresis * keel.stiffness(fulcrum), keel.bending_at_joints * keel.friction
    first = (np.zeros(1), np.zeros(1), np.ones(1)) if keel.twists else (np.zeros(0),) * 3
    size, held, reach = (np.append(*pair) for pair in zip(first, (size, held, keel.reach(fulcrum)), strict=True))
    return size, held, reach


def along_keel(tree: Tree, names: list[str], stiffness: SX, damping: SX, rubbing: Sequence[SX] = ()) -> dict[str, SX]:
    """Torques of springs, dampers and friction along the keel's coordinates, for `equations_of_motion(along=...)`.

    `stiffness` and `damping` are columns of symbols or numbers, in the order of the names: as parameters of the
    equations they let the fulcrum move without new equations. `rubbing` is `keel_friction`.
    """
    found = {}
    for k, name in enumerate(names):
        place = tree.names.index(name)
        found[name] = -stiffness[k] * tree.q[place] - damping[k] * tree.u[place]
        if rubbing:
            found[name] -= rubbing[k]
    return found


def keel_friction(tree: Tree, names: list[str], numbers: SX) -> tuple[list[SX], list[LawState]]:
    """Torque of friction of each joint, and its state z over its limit, z' = (u - |u| z) / reach (Dahl).

    The same loop at any rate. `numbers` are those of `rubbing_numbers` one after the other.
    """
    from casadi import SX, fabs

    count, torques, states = len(names), [], []
    for k, name in enumerate(names):
        z, place = SX.sym(f"rubbed_{name}"), tree.names.index(name)
        q, u = tree.q[place], tree.u[place]
        states.append(LawState(z, (u - fabs(u) * z) / numbers[2 * count + k]))
        torques.append((numbers[k] * fabs(q) + numbers[count + k]) * z)
    return torques, states


def sole_wrenches(
    tree: Tree,
    parent: str,
    X_PK: RigidTransform,
    keel: Keel,
    sole: KeelSole,
    law: SoleLaw,
    ground: HalfSpace,
    *,
    name: str = "keel",
    ending: str = "",
) -> Wrenches:
    """Loads of a plane ground on the parent and the segments through the spheres that each carries.

    `name` and `ending` as for `keel_bodies`.
    """
    laws, loads = laws_of(law), []
    for segment in range(keel.joints + 1):
        spheres = sole.on(segment, keel)
        if spheres is None:
            continue
        own = [one for one, each in zip(laws, sole.segment, strict=True) if each == segment]
        if not segment:
            spheres = replace(spheres, centre=X_PK.apply(spheres.centre))
        body = f"{name}_{segment}{ending}" if segment else parent
        loads.append({body: sole_wrench(tree.bodies[body], spheres, own, ground)})
    return together(*loads)
