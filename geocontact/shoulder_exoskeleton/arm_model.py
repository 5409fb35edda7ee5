"""Equations of one exoskeleton arm: two passive joints and an active one, the cuff around a sphere that is recorded.

The frame of the device stands still: accelerations of the trunk do not act on the arm, as in Yao et al. (2024); gravity
turns with the trunk. Only the right arm is modelled: a left one is its mirror image.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.contact.joint_stop import stop_force
from geocontact.contact.sphere_in_tube import TubeContact, TubeLaw, tube_contact
from geocontact.data.multibody.joint_kinds import revolute
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.body_contact import action_and_reaction
from geocontact.dynamics.equations import Equations, LawState, equations_of_motion
from geocontact.dynamics.equilibrium import Equilibrium
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Moving, Tree, tree_of
from geocontact.shoulder_exoskeleton.arm_numbers import BODIES, COLUMN, SIZES, slices
from geocontact.shoulder_exoskeleton.cylinder import lever
from geocontact.shoulder_exoskeleton.device import JOINTS, Device

if TYPE_CHECKING:
    from casadi import SX, Function

TUBE = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]])
"""Axes of the cuff in the arm link's frame, in columns: distal, medial, and the way it moves when it is raised."""
INPUTS = ("sphere", "sphere_rate", "gravity", "factor")
"""Recorded inputs after those of locked joints: 3, 3, 3 and 1 numbers."""
OUTPUTS: dict[str, int] = {
    "force": 3,
    "in_cuff": 3,
    "normal": 3,
    "friction": 3,
    "sliding": 3,
    "place": 3,
    "pressing": 1,
    "support": 1,
    "stops": 3,
    "energy": 1,
    "power_in": 1,
    "power_lost": 1,
    "joints": 12,
}
"""What is told of a state besides coordinates: see `outputs`."""


@dataclass(frozen=True, eq=False)
class ArmModel:
    """Equations of a right arm and what is made of them.

    Parameters
    ----------
    equations
        Coordinates `JOINTS` that are not locked; memory: force of the cylinder [N]; parameters: `adjusted_numbers`.
    outputs
        (q, u, z, w, p) to `OUTPUTS`.
    stepper, equilibrium
        For motion and for rest.
    """

    equations: Equations
    outputs: Function
    stepper: Stepper
    equilibrium: Equilibrium


def arm_model(device: Device, *, locked: Sequence[str] = (), machine_code: bool = True) -> ArmModel:
    """The model of a device: its numbers are parameters, but for the directions of the axes.

    Parameters
    ----------
    locked
        Joints that an input prescribes.
    machine_code
        Whether to compile where there is a compiler.
    """
    axes = tuple(tuple(map(float, device.axis(joint))) for joint in JOINTS)
    return _made(axes, tuple(locked), machine_code)


@lru_cache(maxsize=8)
def _made(axes: tuple[tuple[float, ...], ...], locked: tuple[str, ...], machine_code: bool) -> ArmModel:
    from casadi import SX, Function, densify, vertcat

    p, w = SX.sym("numbers", sum(SIZES.values())), SX.sym("recorded", 10)
    of = {name: p[place, :] for name, place in slices().items()}
    tree = _tree(axes, of, w[6:9, :])
    push = SX.sym("push")
    arm = tree.bodies["arm"]
    contact, cuff = _contact(tree, of, w)
    force = cuff @ vertcat(*(a + b for a, b in zip(contact.normal, contact.friction, strict=True)))
    k, width, damping = (of["stop"][i] for i in range(3))
    stops = [stop_force(tree.q[i], tree.u[i], of["lower"][i], of["upper"][i], k, width, damping) for i in range(3)]
    support = push * lever(tree.q[2], of["lever"][0], of["lever"][1], of["lever"][2])
    along = {joint: stops[i] - of["damping"][i] * tree.u[i] for i, joint in enumerate(JOINTS)}
    along["elevation"] = along["elevation"] + support
    equations = equations_of_motion(
        tree,
        loads=action_and_reaction("arm", GROUND, -force, w[:3, :]),
        along=along,
        prescribed=locked,
        memory=[LawState(push, (of["push"] * w[9, :] - push) / of["lag"])],
        inputs=[w],
        parameters=[p],
    )
    energy = _energy(tree, of) + 0.5 * of["law"][0] * sum((x * x for x in contact.radial), SX(0))
    lost = sum((of["damping"][i] * tree.u[i] ** 2 for i in range(3)), SX(0))
    slip = vertcat(*contact.sliding)
    lost = lost - vertcat(*contact.friction).T @ slip
    damped = vertcat(*contact.normal) + of["law"][0] * vertcat(*contact.radial)
    moving = cuff.T @ (w[3:6, :] - _speed(arm, w[:3, :]))
    lost = lost - damped.T @ moving
    power = support * tree.u[2] + sum((stops[i] * tree.u[i] for i in range(3)), SX(0)) - force.T @ w[3:6, :]
    place = vertcat(contact.along, contact.radial[1], contact.radial[2])
    joints = [tree.bodies[name].place for name in BODIES] + [tree.point("arm", of["cuff"])]
    told = [force, cuff.T @ force, vertcat(*contact.normal), vertcat(*contact.friction), slip, place]
    told += [contact.pressing, support, vertcat(*stops), energy, power, lost, vertcat(*joints)]
    outputs = Function("outputs", equations.state, [densify(vertcat(*told))])
    return ArmModel(equations, outputs, Stepper(equations, machine_code=machine_code), Equilibrium(equations))


def _tree(axes: tuple[tuple[float, ...], ...], of: dict[str, SX], gravity: SX) -> Tree:
    """Links from joint to joint; numbers of the model are those of the parameters."""
    from casadi import SX

    parents = (GROUND, *BODIES[:-1])
    joints = tuple(
        revolute(joint, parent, body, np.array(axis))
        for joint, parent, body, axis in zip(JOINTS, parents, BODIES, axes, strict=True)
    )
    bodies = tuple(Body(name, 1.0, np.zeros(3), np.eye(3)) for name in BODIES)
    masses, centres, inertias = {}, {}, {}
    for i, name in enumerate(BODIES):
        masses[name] = of["masses"][i]
        centres[name] = of["centres"][3 * i : 3 * i + 3, :]
        matrix = SX(3, 3)
        for k, (a, b) in enumerate(COLUMN):
            matrix[a, b] = of["inertias"][6 * i + k]
            matrix[b, a] = of["inertias"][6 * i + k]
        inertias[name] = matrix
    return tree_of(
        Multibody("exoskeleton arm", bodies, joints, (), np.zeros(3)),
        masses=masses,
        centres=centres,
        inertias=inertias,
        places=dict(zip(JOINTS, (of["base"], of["link_1"], of["link_2"]), strict=True)),
        gravity=gravity,
    )


def _contact(tree: Tree, of: dict[str, SX], w: SX) -> tuple[TubeContact, SX]:
    """Forces on the sphere in the cuff's axes, and these axes in the device's frame."""
    from casadi import SX

    arm = tree.bodies["arm"]
    cuff = arm.rotation @ constant(TUBE)
    offset = cuff.T @ (w[:3, :] - tree.point("arm", of["cuff"]))
    velocity = cuff.T @ (w[3:6, :] - _speed(arm, w[:3, :]))
    law = TubeLaw(*(of["law"][i] for i in range(SIZES["law"])))
    return tube_contact(_components(offset), _components(velocity), (SX(1), SX(0), SX(0)), law), cuff


def _components(vector: SX) -> tuple[SX, SX, SX]:
    return vector[0], vector[1], vector[2]


def _speed(body: Moving, place: SX) -> SX:
    """Velocity of the body's material point at a place of the ground's frame [m/s]."""
    from casadi import cross

    return body.speed + cross(body.spin, place - body.place)


def _energy(tree: Tree, of: dict[str, SX]) -> SX:
    """Of motion and weight [J]."""
    from casadi import SX, cross, dot, sumsqr

    total, gravity = SX(0), SX(3, 1) if tree.gravity is None else tree.gravity
    for name in BODIES:
        frame = tree.bodies[name]
        arm = frame.rotation @ tree.centres[name]
        spin = frame.rotation.T @ frame.spin
        total += 0.5 * tree.masses[name] * sumsqr(frame.speed + cross(frame.spin, arm))
        total += 0.5 * dot(spin, tree.inertias[name] @ spin)
        total -= tree.masses[name] * dot(gravity, frame.place + arm)
    return total


def output_slices() -> dict[str, slice]:
    """Where each of `OUTPUTS` is."""
    ends = np.cumsum([0, *OUTPUTS.values()])
    return {name: slice(int(ends[i]), int(ends[i + 1])) for i, name in enumerate(OUTPUTS)}


Told = dict[str, Float[np.ndarray, "t _"]]
"""`OUTPUTS` by name.

force
    On the human arm, in the device's frame [N].
in_cuff, normal, friction
    The same in the cuff's axes (distal, medial, raising), and its two parts.
sliding, place
    Velocity of the sphere along the wall [m/s] and its place from the cuff's middle [m], in these axes.
pressing
    Normal force, >= 0 [N].
support, stops
    Torque of the cylinder on the active joint, torques of the stops on all [N m].
energy
    Of motion, weight and the interface's spring [J].
power_in, power_lost
    Of cylinder, stops and the sphere's motion; of damping and friction [W].
joints
    Places of the joints from the frame outwards, then the cuff's middle [m].
"""
