"""Equations of motion of pelvis and both legs: the prosthetic sole on the ground, the rest given or driven.

The prosthetic foot's load comes from its spheres. That on the intact foot is given, as a plate measured it, or comes
from spheres as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.keel.on_tree import sole_wrenches
from geocontact.data.multibody.joint import JointModel, TransformAxis
from geocontact.data.multibody.joint_function import Affine
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.body_contact import together
from geocontact.dynamics.equations import Equations, equations_of_motion
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.sphere_contact import laws_of, sole_wrench
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.geometry.shapes import HalfSpace

if TYPE_CHECKING:
    from casadi import SX

INTACT_FOOT, INTACT_TOES = "calcn_l", "toes_l"
FREE = ("pelvis_tx", "pelvis_ty")
"""Of the pelvis: fore and aft, and vertical, which the study leaves free."""


def moving_tree(amputee: Amputee) -> Multibody:
    """The model of a right prosthesis without the coordinates that are held: 24 and the keel's."""
    return without_locked(amputee_tree(amputee))


def without_locked(model: Multibody) -> Multibody:
    """Locked coordinates at their default for good."""
    return replace(model, joints=tuple(map(_unlocked, model.joints)))


def _unlocked(joint: JointModel) -> JointModel:
    held = {c.name: c.default for c in joint.coordinates if c.locked}
    axes = tuple(_still(axis, held) if set(axis.coordinates) & set(held) else axis for axis in joint.axes)
    return replace(joint, axes=axes, coordinates=tuple(c for c in joint.coordinates if not c.locked))


def _still(axis: TransformAxis, held: dict[str, float]) -> TransformAxis:
    value = axis.function(np.array([[held[name] for name in axis.coordinates]]))
    return TransformAxis(axis.direction, (), Affine(np.zeros(0), float(value[0])))


def passive(names: Sequence[str]) -> tuple[str, ...]:
    """Coordinates that nothing drives but springs: socket and keel."""
    return tuple(name for name in names if name.startswith(("socket_", "keel_")))


def spring_forces(tree: Tree, amputee: Amputee) -> dict[str, SX]:
    """Along the coordinates of socket and keel."""
    found = {}
    for name, (stiffness, damping) in amputee.springs().items():
        at = tree.names.index(f"{name}_r")
        found[f"{name}_r"] = -stiffness * tree.q[at] - damping * tree.u[at]
    return found


def prosthetic_loads(tree: Tree, amputee: Amputee) -> Wrenches:
    """Of a level ground on the prosthetic foot."""
    foot = amputee.foot
    none = RigidTransform.identity()
    return sole_wrenches(tree, "calcn_r", none, foot.keel, foot.sole, foot.law, HalfSpace(), ending="_r")


def intact_loads(tree: Tree, amputee: Amputee) -> Wrenches:
    """Of a level ground on the intact foot and its toes, by their spheres."""
    leg = amputee.intact
    found = {}
    for body, spheres, law in zip((INTACT_FOOT, INTACT_TOES), leg.spheres(), leg.laws(), strict=True):
        found[body] = sole_wrench(tree.bodies[body], spheres, laws_of(law), HalfSpace(normal=(0.0, 1.0, 0.0)))
    return found


def equations_of_both(
    amputee: Amputee, *, prescribed: Sequence[str] = (), driven: Sequence[str] = (), intact_on_spheres: bool = False
) -> Equations:
    """Of the coordinates that are not prescribed.

    Parameters
    ----------
    prescribed
        Whose course is an input.
    driven
        Along which a torque or force is given [N m, N].
    intact_on_spheres
        Whether the intact foot has its spheres, beside the load that is given.

    Inputs after those of the prescribed coordinates: force and moment about the ground's origin on the intact foot, in
    the ground's frame [N, N m], then what drives.
    """
    from casadi import SX

    tree = tree_of(moving_tree(amputee))
    ground, torque = SX.sym("ground", 6), SX.sym("torque", len(driven))
    along = spring_forces(tree, amputee) | {name: torque[k] for k, name in enumerate(driven)}
    loads = together(prosthetic_loads(tree, amputee), {INTACT_FOOT: (ground[:3], ground[3:])})
    if intact_on_spheres:
        loads = together(loads, intact_loads(tree, amputee))
    return equations_of_motion(tree, loads=loads, along=along, prescribed=prescribed, inputs=[ground, torque])
