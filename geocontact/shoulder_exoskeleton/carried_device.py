"""Weight and inertia of the exoskeleton's arm, which the person carries: Newton and Euler's equations over its bodies.

Support, stops, damping and the cuff's force on the arm drop out: they act between bodies of the device, or on the trunk
as they act on the arm. The frame stands still, as in the simulation: accelerations of the trunk itself are left out.
Shoulder bar, belt and frame have no mass among the device's numbers.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.shoulder_exoskeleton.arm_model import arm_model
from geocontact.shoulder_exoskeleton.arm_numbers import BODIES, COLUMN, adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.cuff_contact import MIRROR, mirrored_arm
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation

Rows = Float[np.ndarray, "t 3"]


def weight_and_inertia(s: ArmSimulation) -> tuple[Rows, Rows]:
    """Force m (g - a) of the three bodies [N] and its moment about the first passive joint [N m], device's frame."""
    force, moment = _of_a_right_arm(s, adjusted_numbers(s.device, s.wearer, s.level))
    return (force * MIRROR, -moment * MIRROR) if s.motion.side == "left" else (force, moment)


def forces_of_device(s: ArmSimulation) -> dict[str, tuple[Rows, Rows, Rows]]:
    """All that one side of the device does to the person, in its own frame: force [N], where [m], and moment [N m].

    Of the cuff on the upper arm, at the sphere's centre; of the same on the trunk, the opposite; and of the device that
    the trunk carries, its weight and inertia at the first passive joint.
    """
    force, place, moment = s.outputs["force"], s.motion.interface, s.outputs["moment"]
    carried, turned = weight_and_inertia(s)
    return {
        "cuff": (force, place, moment),
        "trunk": (-force, place, -moment),
        "device": (carried, s.outputs["joints"][:, :3], turned),
    }


def _of_a_right_arm(s: ArmSimulation, p: Float[np.ndarray, " p"]) -> tuple[Rows, Rows]:
    of, gravity = slices(), mirrored_arm(s.motion).gravity_at_frames()
    accelerations = _accelerations(s, p)
    count = len(s.angles)
    turn = Rotation.identity(count)
    place, speeding, spin, turning = (np.zeros((count, 3)) for _ in range(4))
    force, moment = np.zeros((count, 3)), np.zeros((count, 3))
    for k, joint in enumerate(JOINTS):
        axis = s.device.axis(joint)
        along, rate = turn.apply(axis), s.rates[:, k, None]
        turning = turning + along * accelerations[:, k, None] + np.cross(spin, along) * rate
        spin = spin + along * rate
        turn = turn * Rotation.from_rotvec(s.angles[:, k, None] * axis)
        arm = turn.apply(p[of["centres"]][3 * k : 3 * k + 3])
        centre = place + arm
        push = p[of["masses"]][k] * (gravity - speeding - _carried(turning, spin, arm))
        own = np.zeros((3, 3))
        for value, (i, j) in zip(p[of["inertias"]][6 * k : 6 * k + 6], COLUMN, strict=True):
            own[i, j] = own[j, i] = value
        inertia = turn.as_matrix() @ own @ turn.as_matrix().swapaxes(1, 2)
        gyroscopic = np.cross(spin, np.einsum("tij,tj->ti", inertia, spin))
        force += push
        moment += np.cross(centre, push) - np.einsum("tij,tj->ti", inertia, turning) - gyroscopic
        if k + 1 < len(BODIES):
            link = turn.apply(p[of[f"link_{k + 1}"]])
            place, speeding = place + link, speeding + _carried(turning, spin, link)
    return force, moment


def _carried(turning: Rows, spin: Rows, arm: Rows) -> Rows:
    """Acceleration of a point of a turning body against another one of it [m/s²]."""
    return np.asarray(np.cross(turning, arm) + np.cross(spin, np.cross(spin, arm)))


def _accelerations(s: ArmSimulation, p: Float[np.ndarray, " p"]) -> Rows:
    """Accelerations of the joints [rad/s²], as the equations of motion have them at the simulated states."""
    run = arm_model(s.device, cuff=s.cuff).equations.accelerations().map(len(s.angles))
    states = (s.angles.T, s.rates.T, s.cylinder[None], s.recorded.T)
    return np.array(run(*states, np.repeat(p[:, None], len(s.angles), axis=1))).T
