"""Both legs in motion: angles given and forces found, forces of a motion, and the motion that those forces make.

The study's two variants. With angles given only the pelvis' advance and height, the socket and the keel are found; the
torques of that motion, played back without any angle given, have to make it again.

The prosthetic foot's load comes from its spheres. That on the intact foot is given, as a plate measured it, or comes
from spheres as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.keel.on_tree import sole_wrenches
from geocontact.data.multibody.joint import Affine, JointModel, TransformAxis
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.equations import Equations, equations_of_motion
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.recorded_inputs import recorded_inputs
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.sphere_contact import laws_of, sole_wrench, together
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.geometry.shapes import HalfSpace

if TYPE_CHECKING:
    from casadi import SX, Function


INTACT_FOOT, INTACT_TOES = "calcn_l", "toes_l"
FREE = ("pelvis_tx", "pelvis_ty")
"""Coordinates of the pelvis, fore and aft and vertical, which the study leaves free."""


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
    """Loads of a level ground on the prosthetic foot."""
    foot = amputee.foot
    none = RigidTransform.identity()
    return sole_wrenches(tree, "calcn_r", none, foot.keel, foot.sole, foot.law, HalfSpace(), ending="_r")


def intact_loads(tree: Tree, amputee: Amputee) -> Wrenches:
    """Loads of a level ground on the intact foot and its toes, by their spheres."""
    leg = amputee.intact
    found = {}
    for body, spheres, law in zip((INTACT_FOOT, INTACT_TOES), leg.spheres(), leg.laws(), strict=True):
        found[body] = sole_wrench(tree.bodies[body], spheres, laws_of(law), HalfSpace(normal=(0.0, 1.0, 0.0)))
    return found


def equations_of_both(
    amputee: Amputee, *, prescribed: Sequence[str] = (), driven: Sequence[str] = (), intact_on_spheres: bool = False
) -> Equations:
    """Equations of the coordinates that are not prescribed.

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


TOLERANCE, FIRST = 1e-5, 1e-4
"""Error allowed in a step [m, rad, m/s, rad/s], plus as much of each one's size, and first step [s]."""


@dataclass(frozen=True, eq=False)
class GivenWalk:
    """What is known of a walk of a person with a right prosthesis, at even times.

    Parameters
    ----------
    time
        [s].
    names, values
        Coordinates that were recorded [rad, m], the pelvis' advance and height among them.
    ground
        Force on the intact foot, and its moment about the ground's origin [N, N m].
    """

    time: Float[np.ndarray, " t"]
    names: tuple[str, ...]
    values: Float[np.ndarray, "t n"]
    ground: Float[np.ndarray, "t 6"]


@dataclass(frozen=True, eq=False)
class WholeMotion:
    """A motion of all coordinates.

    Parameters
    ----------
    time, names, q, u
        [s], coordinates and rates [rad, m, s].
    own, intact
        Of the ground by the spheres of the prosthetic and, where it has some, of the intact foot: force and moment
        about the ground's origin [N, N m].
    steps
        That were taken.
    """

    time: Float[np.ndarray, " t"]
    names: tuple[str, ...]
    q: Float[np.ndarray, "t n"]
    u: Float[np.ndarray, "t n"]
    own: Float[np.ndarray, "t 6"]
    intact: Float[np.ndarray, "t 6"]
    steps: int

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the ground on the prosthetic foot [N]."""
        return self.own[:, :3]

    def part(self, start: float, stop: float) -> WholeMotion:
        """Between two times [s]."""
        on = (self.time >= start - 1e-9) & (self.time <= stop + 1e-9)
        q, u, own, intact = self.q[on], self.u[on], self.own[on], self.intact[on]
        return WholeMotion(self.time[on], self.names, q, u, own, intact, self.steps)

    def of(self, name: str) -> Float[np.ndarray, " t"]:
        """One coordinate."""
        return self.q[:, self.names.index(name)]


def coordinate_names(amputee: Amputee) -> tuple[str, ...]:
    """Names of the coordinates of the moving tree."""
    return tuple(c.name for c in moving_tree(amputee).coordinates)


def walk_by_angles(
    amputee: Amputee,
    given: GivenWalk,
    time: Float[np.ndarray, " t"],
    *,
    intact_on_spheres: bool = False,
    tolerance: float = TOLERANCE,
    machine_code: bool = True,
) -> WholeMotion:
    """From the recorded place and speed of the pelvis at the first of some even times; socket and keel start at rest.

    ArithmeticError where the motion cannot go on.
    """
    names = coordinate_names(amputee)
    prescribed = _prescribed(names)
    equations = equations_of_both(amputee, prescribed=prescribed, intact_on_spheres=intact_on_spheres)
    stepper = Stepper(equations, machine_code=machine_code)
    columns = [given.names.index(name) for name in prescribed]
    course = recorded_inputs(given.time, given.values[:, columns], derivatives=2)
    inputs = course.beside(recorded_inputs(given.time, given.ground))
    free = equations.names
    place = recorded_inputs(given.time, given.values[:, [given.names.index(name) for name in FREE]])
    q, u = np.zeros(len(free)), np.zeros(len(free))
    at = [free.index(name) for name in FREE]
    q[at], u[at] = place(float(time[0]))
    found = stepper.simulate((q, u, np.zeros(0)), time, inputs=inputs, tolerance=tolerance, first=FIRST)
    known = course.at(time)
    whole = {name: (known[:, k], known[:, len(columns) + k]) for k, name in enumerate(prescribed)}
    whole |= {name: (found.q[:, k], found.u[:, k]) for k, name in enumerate(found.names)}
    values, rates = (np.column_stack([whole[name][k] for name in names]) for k in (0, 1))
    own, intact = _pressing(amputee, values, rates, intact_on_spheres)
    return WholeMotion(time, names, values, rates, own, intact, found.steps)


def accelerations_by_angles(
    amputee: Amputee, given: GivenWalk, walk: WholeMotion, *, intact_on_spheres: bool = False
) -> Float[np.ndarray, "t n"]:
    """Accelerations of all coordinates of such a walk [rad/s², m/s²]: those of what is found by the equations, the
    rest as given.
    """
    prescribed = _prescribed(walk.names)
    equations = equations_of_both(amputee, prescribed=prescribed, intact_on_spheres=intact_on_spheres)
    columns = [given.names.index(name) for name in prescribed]
    course = recorded_inputs(given.time, given.values[:, columns], derivatives=2)
    w = course.beside(recorded_inputs(given.time, given.ground)).at(walk.time)
    which = [walk.names.index(name) for name in equations.names]
    found = _mapped(equations.accelerations(), equations, walk.q[:, which], walk.u[:, which], w)
    whole = np.zeros_like(walk.q)
    whole[:, which] = found
    whole[:, [walk.names.index(name) for name in prescribed]] = w[:, 2 * len(columns) : 3 * len(columns)]
    return whole


def driving_forces(
    amputee: Amputee,
    walk: WholeMotion,
    accelerations: Float[np.ndarray, "t n"],
    ground: Float[np.ndarray, "t 6"],
    *,
    intact_on_spheres: bool = False,
) -> Float[np.ndarray, "t n"]:
    """What acts along each coordinate beside gravity, the ground and the springs [N m, N]: of a pelvis what holds it.

    Parameters
    ----------
    ground
        Given on the intact foot at the times of the walk, as of `GivenWalk`.
    """
    from casadi import Function, densify

    equations = equations_of_both(amputee, intact_on_spheres=intact_on_spheres)
    state = [*equations.state[:2], equations.a, *equations.state[3:]]
    needed = Function("needed", state, [densify(-equations.balance)])
    count = len(walk.time)
    none = np.zeros((0, count))
    return np.array(needed.map(count)(walk.q.T, walk.u.T, accelerations.T, ground.T, none)).T


def driven_stepper(amputee: Amputee, *, intact_on_spheres: bool = False, machine_code: bool = True) -> Stepper:
    """Stepper of a walk by forces: all coordinates free, socket and keel by their springs alone."""
    driven = _driven(coordinate_names(amputee))
    equations = equations_of_both(amputee, driven=driven, intact_on_spheres=intact_on_spheres)
    return Stepper(equations, machine_code=machine_code)


def walk_by_forces(
    amputee: Amputee,
    stepper: Stepper,
    start: WholeMotion,
    time: Float[np.ndarray, " t"],
    ground: Float[np.ndarray, "t 6"],
    forces: Float[np.ndarray, "t n"],
    *,
    intact_on_spheres: bool = False,
    tolerance: float = TOLERANCE,
) -> WholeMotion:
    """From the first state of a walk, by its forces at its times and nothing else.

    Parameters
    ----------
    stepper
        `driven_stepper`.
    ground
        At the times of `start`.
    forces
        Of `driving_forces` at the times of `start`; those along socket and keel are not used.

    ArithmeticError where the motion cannot go on.
    """
    names = start.names
    columns = [names.index(name) for name in _driven(names)]
    inputs = recorded_inputs(start.time, np.hstack([ground, forces[:, columns]]))
    state = (start.q[0], start.u[0], np.zeros(0))
    found = stepper.simulate(state, time, inputs=inputs, tolerance=tolerance, first=FIRST)
    own, intact = _pressing(amputee, found.q, found.u, intact_on_spheres)
    return WholeMotion(time, names, found.q, found.u, own, intact, found.steps)


def _prescribed(names: Sequence[str]) -> list[str]:
    return [name for name in names if name not in FREE and name not in passive(names)]


def _driven(names: Sequence[str]) -> list[str]:
    return [name for name in names if name not in passive(names)]


def _pressing(
    amputee: Amputee, q: Float[np.ndarray, "t n"], u: Float[np.ndarray, "t n"], intact_on_spheres: bool
) -> tuple[Float[np.ndarray, "t 6"], Float[np.ndarray, "t 6"]]:
    """Load of the ground by the spheres of both feet: force and moment about its origin [N, N m]."""
    from casadi import SX, Function, densify, vertcat

    tree = tree_of(moving_tree(amputee))
    both: list[Wrenches] = [prosthetic_loads(tree, amputee)]
    both.append(intact_loads(tree, amputee) if intact_on_spheres else {})
    told = []
    for loads in both:
        total = SX(6, 1)
        for force, moment in loads.values():
            total = total + vertcat(force, moment)
        told.append(densify(total))
    run = Function("pressing", [tree.q, tree.u], told)
    found = [np.array(each).T for each in run.map(len(q))(q.T, u.T)]
    return found[0], found[1]


def _mapped(
    function: Function,
    equations: Equations,
    q: Float[np.ndarray, "t n"],
    u: Float[np.ndarray, "t n"],
    w: Float[np.ndarray, "t w"],
) -> Float[np.ndarray, "t n"]:
    none = np.zeros((0, len(q)))
    return np.array(function.map(len(q))(q.T, u.T, none, w.T, none)).T
