"""A simulated arm as others see it: in its plane of elevation, and on a pressure mat under it.

The upper arm's elevation is the base model's angle a; its length L_h, and where the hinge is from the human shoulder,
are means over the trial. What the hinge moves by, and what happens out of the plane, is what such a case leaves out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.device import lever
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation

ACTIVE = 2
"""Place of the active joint among those of a simulation."""
SUPPORTED = np.radians(np.arange(-20.0, 181.0, 2.0))


@dataclass(frozen=True, eq=False)
class PlaneArm:
    """Constants of the base model, its table of support torques, and how much the hinge moves.

    Parameters
    ----------
    constants
        L_h, o_x, o_y [m], I [kg m²], c [N m s/rad], l_c [m], and the law's start: k_t [N/m], b_t [N s/m], m [kg].
    angle, torque
        Of full support [rad, N m].
    moved
        Standard deviation of the hinge from the human shoulder, forwards and upwards [m].
    """

    constants: dict[str, float]
    angle: Float[np.ndarray, " a"]
    torque: Float[np.ndarray, " a"]
    moved: tuple[float, float]


def plane_arm(s: ArmSimulation) -> PlaneArm:
    """Constants of one arm over its trial."""
    d, of, p = s.device, slices(), adjusted_numbers(s.device, s.wearer, 1.0)
    upper = s.motion.interface - s.motion.shoulder
    length = np.linalg.norm(upper, axis=1)
    hinge = s.outputs["joints"].reshape(-1, 4, 3)[:, ACTIVE] - s.motion.shoulder
    across = upper[:, :2] / np.maximum(np.linalg.norm(upper[:, :2], axis=1, keepdims=True), 1e-9)
    forwards = (hinge[:, :2] * across).sum(axis=1)
    weights = np.linalg.norm(upper[:, :2], axis=1)  # an arm that hangs has no plane
    o_x, o_y = (float(np.average(each, weights=weights)) for each in (forwards, hinge[:, 2]))
    spread = [
        np.sqrt(np.average((each - m) ** 2, weights=weights)) for each, m in ((forwards, o_x), (hinge[:, 2], o_y))
    ]
    mass, centre = float(p[of["masses"]][2]), -float(p[of["centres"]][8])
    constants = {
        "L_h": float(length.mean()),
        "o_x": o_x,
        "o_y": o_y,
        "I": float(p[of["inertias"]][12]) + mass * centre**2,
        "c": d["elevation_damping"],
        "l_c": centre,
        "k_t": d["k"],
        "b_t": d["b"],
        "m": mass,
    }
    torque = d.peak_force * lever(SUPPORTED, d["lever_a"], d["lever_b"], d["lever_phase"])
    return PlaneArm(constants, SUPPORTED, np.asarray(torque), (float(spread[0]), float(spread[1])))


PLACES = 180
"""Places of springs around the cuff."""


def armrest_force(s: ArmSimulation, pressed: Float[np.ndarray, " t"] | None = None) -> Float[np.ndarray, " t"]:
    """Force with which the armrest alone presses the arm up [N], without friction and damping.

    Above it a strap presses down (`contact.sphere_in_tube`): that part of the force on the arm no mat below sees.

    Parameters
    ----------
    pressed
        As the simulation was given it [N].
    """
    k, strap = s.device["k"], s.device["strap"]
    radial = s.outputs["place"][:, 1:].copy()
    if pressed is not None:
        radial[:, 1] -= pressed / k
    angle = -np.pi * (np.arange(PLACES // 2) + 0.5) / (PLACES // 2)  # from medial downwards
    depth = radial @ np.array([np.cos(angle), np.sin(angle)]) + strap
    each = 2.0 * k / np.pi * np.maximum(depth, 0.0) * -np.sin(angle)
    return np.asarray(each.sum(axis=1) * 2.0 * np.pi / PLACES)
