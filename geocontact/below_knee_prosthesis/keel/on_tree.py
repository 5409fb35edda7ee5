"""The keel as bodies, joints and forces of a tree (`dynamics.tree`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.joint_kinds import revolute
from geocontact.data.multibody.model import Body
from geocontact.dynamics.body_contact import together
from geocontact.dynamics.equations import LawState
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.sphere_contact import laws_of, sole_wrench
from geocontact.dynamics.tree import Tree
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SoleLaw

if TYPE_CHECKING:
    from casadi import SX

TORSION = "torsion"


def keel_bodies(
    keel: Keel, parent: str, X_PK: RigidTransform, *, name: str = "keel", torsion: bool = False, ending: str = ""
) -> tuple[tuple[Body, ...], tuple[JointModel, ...]]:
    """Segments in front of the first joint, and their joints, to follow the parent's in a `Multibody`.

    Bodies, joints and coordinates are `name`_1 to `name`_n. What lies behind the first joint is rigid: it is part of
    the parent, whose mass has to hold it (`posterior_part`).

    Parameters
    ----------
    X_PK
        Pose of the keel's frame in the parent.
    torsion
        Whether the first joint also turns about the keel's long axis, before all others: `name`_torsion.
    ending
        Of all these names, as that of a side.
    """
    forward, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    at = X_PK * RigidTransform.from_translation(keel.places[0] * forward)
    bodies, joints, before = [], [], parent
    if torsion:
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


def coordinates(keel: Keel, *, name: str = "keel", torsion: bool = False) -> list[str]:
    """Names in the tree's order."""
    return [*([f"{name}_{TORSION}"] if torsion else []), *(f"{name}_{k}" for k in range(1, keel.joints + 1))]


def joint_numbers(keel: Keel, fulcrum: float, *, torsion: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness [N m/rad] and damping [N m s/rad] in the order of `coordinates`."""
    stiffness, damping = keel.stiffness(fulcrum), keel.damping(fulcrum)
    if torsion:
        k, b = keel.torsion(fulcrum)
        return np.append(k, stiffness), np.append(b, damping)
    return stiffness, damping


def rubbing_numbers(keel: Keel, fulcrum: float, *, torsion: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Friction over the angle's size [N m/rad] and at any angle [N m], and the turn over which both build up [rad].

    None in torsion.
    """
    size, held = keel.hysteresis * keel.stiffness(fulcrum), np.full(keel.joints, keel.bending * keel.friction)
    first = (np.zeros(1), np.zeros(1), np.ones(1)) if torsion else (np.zeros(0),) * 3
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
