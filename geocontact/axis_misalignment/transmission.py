"""What the cuff passes to the forearm besides the force along it: a moment, a force across, the torque of the joint.

The explicit model's constraints fix the rest of its statics. The link's end stays on the forearm's line, which takes a
force Q across it and no friction; the force F along the limb acts z away from that line, at a bar across the link that
slides without friction; the cuff has a stiffness κ against turning by γ, 0 unless given. In terms of the link's end

    M = κ γ - F z/cos² γ        moment on the forearm, the derivative of the cuff's energy by γ
    Q = (τ - M - F l sin γ)/(l cos γ)        from the moments about the exoskeleton's axis, τ the actuator's torque
    joint's torque = (τ - F l sin γ - M dγ/dβ)/(dα/dβ) = Q |tip| + M,        dα/dβ = l cos γ/|tip| = 1 - dγ/dβ

by virtual work: τ dβ = (joint's torque) dα + F dd + κ γ dγ with dd/dβ = l sin γ - z/cos² γ dγ/dβ. All are positive
towards flexion, moments and forces those on the forearm; F is positive away from the joint on the cuff, as everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.explicit import require_no_pole_at
from geocontact.axis_misalignment.fixation import Yielded


@dataclass(frozen=True, eq=False)
class CuffLoads:
    """On the forearm at the link's end, and at the joint; flexion positive.

    Parameters
    ----------
    gamma
        Angle of the link less that of the forearm [rad].
    moment
        On the forearm about the link's end [N m].
    across
        Force on the forearm across it [N], towards flexion.
    joint_torque
        What the forearm passes to the joint [N m]; muscles and gravity hold it, they are not in the model.
    constraint_torque
        What the constraint forces hold of the actuator's torque about the exoskeleton's axis [N m].
    ratio
        dα/dβ [-]: of the rest, the joint has 1/ratio.
    """

    gamma: Float[np.ndarray, " n"]
    moment: Float[np.ndarray, " n"]
    across: Float[np.ndarray, " n"]
    joint_torque: Float[np.ndarray, " n"]
    constraint_torque: Float[np.ndarray, " n"]
    ratio: Float[np.ndarray, " n"]


def cuff_loads(
    beta: Float[np.ndarray, " n"],
    link: tuple[float, float],
    under_load: Yielded,
    *,
    turning: float = 0.0,
    torque: float | Float[np.ndarray, " n"] = 0.0,
) -> CuffLoads:
    """Loads at exoskeleton angles `beta` [rad] with the force and the offsets that it has there.

    ValueError at a pole of tan γ.

    Parameters
    ----------
    link
        l and z [m].
    turning
        Stiffness κ of the cuff against turning [N m/rad].
    torque
        Of the actuator about the exoskeleton's axis [N m].
    """
    l, z = link
    force, x, y = under_load.force, under_load.x, under_load.y
    s, c = np.sin(beta), np.cos(beta)
    top, bottom = x * c + y * s, l + y * c - x * s
    require_no_pole_at(beta, bottom, l)
    reach, gamma = np.hypot(top, bottom), np.arctan2(top, bottom)
    ratio = l * bottom / reach**2
    moment = turning * gamma - force * z * (reach / bottom) ** 2
    held = force * l * top / reach + moment * (1.0 - ratio)
    joint = (torque - held) / ratio
    return CuffLoads(gamma, moment, (joint - moment) / reach, joint, held, ratio)
