"""What MuJoCo and Pinocchio say of a tree of bodies, asked in a process of its own: their libraries and CasADi's.

Joints whose coordinates are turns about and shifts along axes of the joint frames, first the turns and then the shifts.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.model import GROUND, Body, Multibody


def _moves(joint: JointModel) -> list[tuple[str, np.ndarray, str]]:
    """Shifts, then turns, with their axes in the joint frame and their coordinates: as they follow each other."""
    found = [(k >= 3, axis.direction, axis.coordinates[0]) for k, axis in enumerate(joint.axes) if axis.coordinates]
    shifts = [("slide", direction, name) for shift, direction, name in found if shift]
    return shifts + [("hinge", direction, name) for shift, direction, name in found if not shift]


def _order(model: Multibody) -> list[int]:
    """Places among the model's coordinates of those that the other library counts one after the other."""
    names = [c.name for c in model.coordinates]
    return [names.index(name) for joint in model.joints for _, _, name in _moves(joint)]


def mujoco_inverse_dynamics(model: Multibody, q: np.ndarray, u: np.ndarray, a: np.ndarray) -> np.ndarray:
    import mujoco

    theirs = mujoco.MjModel.from_xml_string(_xml(model))
    data, order = mujoco.MjData(theirs), _order(model)
    found = np.zeros(q.shape)
    for k in range(len(q)):
        data.qpos[:], data.qvel[:], data.qacc[:] = q[k][order], u[k][order], a[k][order]
        mujoco.mj_inverse(theirs, data)
        found[k, order] = data.qfrc_inverse
    return found


def pinocchio_inverse_dynamics(
    model: Multibody, q: np.ndarray, u: np.ndarray, a: np.ndarray, loads: dict[str, np.ndarray] | None = None
) -> np.ndarray:
    """`loads` on bodies are force and moment about the ground's origin in its axes, (s, 6)."""
    import pinocchio as pin

    theirs = pin.Model()
    theirs.gravity.linear = model.gravity
    inertias = {body.name: body for body in model.bodies}
    at = {GROUND: (0, RigidTransform.identity())}
    for joint in model.joints:
        parent, place = at[joint.parent]
        place = place * joint.parent_offset
        for k, (kind, direction, _) in enumerate(_moves(joint)):
            unaligned = pin.JointModelPrismaticUnaligned if kind == "slide" else pin.JointModelRevoluteUnaligned
            parent = theirs.addJoint(parent, unaligned(direction), _se3(pin, place), f"{joint.name}{k}")
            place = RigidTransform.identity()
        place = place * joint.child_offset.inv()
        at[joint.child] = (parent, place)
        body = inertias[joint.child]
        theirs.appendBodyToJoint(parent, pin.Inertia(body.mass, body.centre, body.inertia), _se3(pin, place))
    data, order = theirs.createData(), _order(model)
    found = np.zeros(q.shape)
    for k in range(len(q)):
        pin.forwardKinematics(theirs, data, q[k][order])
        push = [pin.Force.Zero() for _ in range(theirs.njoints)]
        for name, wrench in (loads or {}).items():
            push[at[name][0]] += data.oMi[at[name][0]].actInv(pin.Force(wrench[k, :3], wrench[k, 3:]))
        found[k, order] = pin.rnea(theirs, data, q[k][order], u[k][order], a[k][order], push)
    return found


def _se3(pin: object, pose: RigidTransform) -> object:
    return pin.SE3(pose.rotation.as_matrix(), pose.translation)  # type: ignore[attr-defined]


def _xml(model: Multibody) -> str:
    children: dict[str, list[JointModel]] = {}
    for joint in model.joints:
        children.setdefault(joint.parent, []).append(joint)
    bodies = {body.name: body for body in model.bodies}

    def inside(name: str) -> str:
        return "".join(body(joint) for joint in children.get(name, []))

    def body(joint: JointModel) -> str:
        rest = joint.parent_offset * joint.child_offset.inv()
        turn, at = joint.child_offset.rotation, joint.child_offset.translation
        joints = "".join(
            f'<joint type="{kind}" pos="{_numbers(at)}" axis="{_numbers(turn.apply(direction))}"/>'
            for kind, direction, _ in _moves(joint)
        )
        quat = rest.rotation.as_quat(scalar_first=True)
        return (
            f'<body name="{joint.child}" pos="{_numbers(rest.translation)}" quat="{_numbers(quat)}">{joints}'
            f"{_inertial(bodies[joint.child])}{inside(joint.child)}</body>"
        )

    return (
        f'<mujoco><compiler angle="radian"/><option gravity="{_numbers(model.gravity)}"><flag contact="disable"/>'
        f"</option><worldbody>{inside(GROUND)}</worldbody></mujoco>"
    )


def _inertial(body: Body) -> str:
    i = body.inertia
    six = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
    return f'<inertial pos="{_numbers(body.centre)}" mass="{body.mass!r}" fullinertia="{_numbers(six)}"/>'


def _numbers(values: np.ndarray | list[float]) -> str:
    return " ".join(f"{float(x):.17g}" for x in values)
