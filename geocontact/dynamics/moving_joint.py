"""One joint in symbols: where its moving frame is in its fixed one, how fast it turns and shifts, how that changes.

Of X_J = (R, p): R turns about three body-fixed axes in turn, p shifts along three directions of the fixed frame, each
by a function of coordinates (Seth et al. 2010, Minimal formulation of joint motion for biomechanisms, Nonlin Dyn 62).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from geocontact.data.multibody.joint import JointModel
from geocontact.dynamics.symbols import constant, turn, value_of

if TYPE_CHECKING:
    from casadi import SX


@dataclass(frozen=True)
class MovingJoint:
    """Everything in the joint's frame fixed to the parent.

    Parameters
    ----------
    rotation, shift
        Pose of the moving frame, (3, 3) and (3,) [m].
    spin, speed
        Angular velocity [rad/s] and velocity of the moving frame's origin [m/s].
    spin_rate, speed_rate
        Their derivatives in time, as the fixed frame sees them.
    spin_per_rate, speed_per_rate
        Derivatives of `spin` and `speed` by the joint's own rates, (3, k).
    """

    rotation: SX
    shift: SX
    spin: SX
    speed: SX
    spin_rate: SX
    speed_rate: SX
    spin_per_rate: SX
    speed_per_rate: SX


def moving_joint(joint: JointModel, q: SX, u: SX, a: SX) -> MovingJoint:
    """A joint whose k coordinates, rates and accelerations are these columns [rad, m, s]."""
    from casadi import SX, jacobian, jtimes, mtimes, vertcat

    names = [c.name for c in joint.coordinates]
    amounts = [
        value_of(axis.function, vertcat(*(q[names.index(name)] for name in axis.coordinates))) for axis in joint.axes
    ]
    rotation, spin = SX.eye(3), SX(3, 1)
    for axis, angle in zip(joint.axes[:3], amounts[:3], strict=True):
        spin = spin + mtimes(rotation, constant(axis.direction)) * jtimes(angle, q, u)
        rotation = mtimes(rotation, turn(axis.direction, angle))
    shift = SX(3, 1)
    for axis, length in zip(joint.axes[3:], amounts[3:], strict=True):
        shift = shift + constant(axis.direction) * length
    if joint.reverse:
        spin, rotation = -mtimes(rotation.T, spin), rotation.T
        shift = -mtimes(rotation, shift)
    speed = jtimes(shift, q, u)
    spin_rate, speed_rate = (jtimes(of, q, u) + jtimes(of, u, a) for of in (spin, speed))
    return MovingJoint(rotation, shift, spin, speed, spin_rate, speed_rate, jacobian(spin, u), jacobian(speed, u))
