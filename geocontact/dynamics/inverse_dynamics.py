"""Generalised forces that a motion needs: Newton and Euler for each body, summed from the tips to the ground.

Luh, Walker & Paul (1980), On-line computational scheme for mechanical manipulators; Featherstone (2008), Rigid Body
Dynamics Algorithms, ch. 5. Everything is in the ground's frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from geocontact.data.multibody.model import GROUND
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Tree

if TYPE_CHECKING:
    from casadi import SX

Wrenches = Mapping[str, "tuple[SX, SX]"]
"""By body: force [N] and moment about the ground's origin [N m], in the ground's frame."""


def generalised_forces(tree: Tree, loads: Wrenches | None = None) -> SX:
    """What acts along each coordinate, beside gravity and the loads [N m, N], for `tree.q`, `tree.u` and `tree.a`."""
    from casadi import cross, mtimes, vertcat

    needed = {body.name: _needed(tree, body.name) for body in tree.model.bodies}
    for name, (force, moment) in (loads or {}).items():
        if name != GROUND:
            needed[name] = (needed[name][0] - force, needed[name][1] - moment)
    parts: list[SX] = []
    for joint, axis in reversed(list(zip(tree.model.joints, tree.axes, strict=True))):
        force, moment = needed[joint.child]
        about = moment - cross(axis.place, force)
        parts.insert(0, mtimes(axis.spin.T, about) + mtimes(axis.speed.T, force))
        if joint.parent != GROUND:
            needed[joint.parent] = (needed[joint.parent][0] + force, needed[joint.parent][1] + moment)
    return vertcat(*parts)


def _needed(tree: Tree, name: str) -> tuple[SX, SX]:
    """Force that accelerates a body against gravity, and its moment about the ground's origin with that of its spin."""
    from casadi import cross, mtimes

    body = next(each for each in tree.model.bodies if each.name == name)
    frame = tree.bodies[name]
    arm = mtimes(frame.rotation, tree.centres.get(name, constant(body.centre)))
    gravity = constant(tree.model.gravity) if tree.gravity is None else tree.gravity
    fast = frame.speed_rate + cross(frame.spin_rate, arm) + cross(frame.spin, cross(frame.spin, arm))
    force = tree.masses.get(name, body.mass) * (fast - gravity)
    inertia = mtimes(frame.rotation, mtimes(tree.inertias.get(name, constant(body.inertia)), frame.rotation.T))
    spun = mtimes(inertia, frame.spin_rate) + cross(frame.spin, mtimes(inertia, frame.spin))
    return force, spun + cross(frame.place + arm, force)
