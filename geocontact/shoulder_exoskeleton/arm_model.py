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
from geocontact.data.multibody.joint import revolute
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.equations import Equations, LawState, equations_of_motion
from geocontact.dynamics.equilibrium import Equilibrium
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.sphere_contact import action_and_reaction, together
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.shoulder_exoskeleton.arm_numbers import BODIES, COLUMN, SIZES, slices
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff, held_at_a_point, held_by_a_surface
from geocontact.shoulder_exoskeleton.device import JOINTS, Device, lever

if TYPE_CHECKING:
    from casadi import SX, Function

TUBE = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]])
"""Axes of the cuff in the arm link's frame, in columns: distal, medial, and the way it moves when it is raised."""
RECORDED: dict[Cuff, int] = {"point": 11, "surface": 16}
"""Recorded inputs after those of locked joints: place of the sphere, its velocity, gravity, the support's factor; for a
point also the force that presses it into the cuff, for a surface the direction of the arm's line and its rate."""
OUTPUTS: dict[str, int] = {
    "force": 3,
    "in_cuff": 3,
    "couple": 3,
    "moment": 3,
    "normal": 3,
    "friction": 3,
    "sliding": 3,
    "place": 3,
    "pressing": 1,
    "centre": 1,
    "peak": 1,
    "share": 1,
    "support": 1,
    "stops": 3,
    "energy": 1,
    "power_in": 1,
    "power_lost": 1,
    "joints": 12,
}
"""What is known of a state besides coordinates: see `outputs`."""


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


def arm_model(
    device: Device, *, locked: Sequence[str] = (), machine_code: bool = True, cuff: Cuff = "point"
) -> ArmModel:
    """The model of a device: its numbers are parameters, but for the directions of the axes.

    Parameters
    ----------
    locked
        Joints that an input prescribes.
    machine_code
        Whether to compile where there is a compiler.
    cuff
        How the arm is held: at a point, or by the surface of a padded cuff.
    """
    axes = tuple(tuple(map(float, device.axis(joint))) for joint in JOINTS)
    return _made(axes, tuple(locked), machine_code, cuff)


@lru_cache(maxsize=8)
def _made(axes: tuple[tuple[float, ...], ...], locked: tuple[str, ...], machine_code: bool, cuff: Cuff) -> ArmModel:
    from casadi import SX, Function, densify, tanh, vertcat

    p, w = SX.sym("numbers", sum(SIZES.values())), SX.sym("recorded", RECORDED[cuff])
    of = {name: p[place, :] for name, place in slices().items()}
    tree, push = _tree(axes, of, w[6:9, :]), SX.sym("push")
    arm, middle = tree.bodies["arm"], tree.point("arm", of["cuff"])
    turned = arm.rotation @ constant(TUBE)
    held = (held_at_a_point if cuff == "point" else held_by_a_surface)(arm, turned, middle, of, w)
    k, width, damping = (of["stop"][i] for i in range(3))
    stops = [stop_force(tree.q[i], tree.u[i], of["lower"][i], of["upper"][i], k, width, damping) for i in range(3)]
    support = push * lever(tree.q[2], of["lever"][0], of["lever"][1], of["lever"][2])
    along = {joint: stops[i] - of["damping"][i] * tree.u[i] for i, joint in enumerate(JOINTS)}
    seal = of["seal"][0] * tanh(tree.u[2] / of["seal"][1])
    along["elevation"] = along["elevation"] + support - seal
    back = together(action_and_reaction("arm", GROUND, -held.force, w[:3, :]), {"arm": (SX(3, 1), -held.couple)})
    equations = equations_of_motion(
        tree,
        loads=back,
        along=along,
        prescribed=locked,
        memory=[LawState(push, (of["push"] * w[9, :] - push) / of["lag"])],
        inputs=[w],
        parameters=[p],
    )
    damped = sum((of["damping"][i] * tree.u[i] ** 2 for i in range(3)), seal * tree.u[2])
    power = support * tree.u[2] + sum((stops[i] * tree.u[i] for i in range(3)), SX(0)) + held.fed
    told = {
        "force": held.force,
        "in_cuff": turned.T @ held.force,
        "couple": turned.T @ held.couple,
        "moment": held.couple,
        "normal": held.normal,
        "friction": held.friction,
        "sliding": held.sliding,
        "place": held.place,
        "pressing": held.pressing,
        "centre": held.centre,
        "peak": held.peak,
        "share": held.share,
        "support": support,
        "stops": vertcat(*stops),
        "energy": _energy(tree, of) + held.stored,
        "power_in": power,
        "power_lost": damped + held.lost,
        "joints": vertcat(*(tree.bodies[name].place for name in BODIES), middle),
    }
    outputs = Function("outputs", equations.state, [densify(vertcat(*(told[name] for name in OUTPUTS)))])
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


def _energy(tree: Tree, of: dict[str, SX]) -> SX:
    """Energy of motion and weight [J]."""
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


Outputs = dict[str, Float[np.ndarray, "t _"]]
"""`OUTPUTS` by name.

force
    On the human arm, in the device's frame [N].
in_cuff, couple, moment, normal, friction
    The same in the cuff's axes (distal, medial, raising), the moment about the sphere's centre [N m], and the force's
    two parts.
sliding, place
    Velocity of the sphere along the wall [m/s] and its place from the cuff's middle [m], in these axes.
pressing, centre, peak, share
    Normal force, or pressures times areas, >= 0 [N]; centre of the pressures along the cuff [m]; largest pressure [Pa]
    and share of the wall that is pressed on, 0 where the arm is held at a point.
support, stops
    Torque of the cylinder on the active joint, torques of the stops on all [N m].
energy
    Of motion, weight and the interface's spring [J].
power_in, power_lost
    Of cylinder, stops and the sphere's motion; of damping and friction [W].
joints
    Places of the joints from the frame outwards, then the cuff's middle [m].
"""
