"""A tree of bodies in symbols: poses, velocities and accelerations in the ground's frame, from the ground outwards.

Of X_J = (R, p): R turns about three body-fixed axes in turn, p shifts along three directions of the fixed frame, each
by a function of coordinates (Seth et al. 2010, Minimal formulation of joint motion for biomechanisms, Nonlin Dyn 62).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.dynamics.symbols import apply_numpy, constant, entries, turn, value_of

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


@dataclass(frozen=True)
class Moving:
    """A frame in the ground's frame.

    Parameters
    ----------
    rotation, place
        Pose, (3, 3) and (3,) [m].
    spin, speed
        Angular velocity [rad/s] and velocity of the origin [m/s].
    spin_rate, speed_rate
        Angular acceleration and acceleration of the origin.
    """

    rotation: SX
    place: SX
    spin: SX
    speed: SX
    spin_rate: SX
    speed_rate: SX

    def carried(self, offset: RigidTransform, place: SX | None = None) -> Moving:
        """A frame that is fixed to this one with that pose; `place` says where instead of the pose's translation."""
        from casadi import cross, mtimes

        arm = mtimes(self.rotation, constant(offset.translation) if place is None else place)
        return Moving(
            mtimes(self.rotation, constant(offset.rotation.as_matrix())),
            self.place + arm,
            self.spin,
            self.speed + cross(self.spin, arm),
            self.spin_rate,
            self.speed_rate + cross(self.spin_rate, arm) + cross(self.spin, cross(self.spin, arm)),
        )

    def moved(self, by: MovingJoint) -> Moving:
        """The moving frame of a joint whose fixed frame this is."""
        from casadi import cross, mtimes

        arm, spin, speed = (mtimes(self.rotation, each) for each in (by.shift, by.spin, by.speed))
        spin_rate, speed_rate = (mtimes(self.rotation, each) for each in (by.spin_rate, by.speed_rate))
        return Moving(
            mtimes(self.rotation, by.rotation),
            self.place + arm,
            self.spin + spin,
            self.speed + cross(self.spin, arm) + speed,
            self.spin_rate + spin_rate + cross(self.spin, spin),
            self.speed_rate
            + cross(self.spin_rate, arm)
            + cross(self.spin, cross(self.spin, arm))
            + 2.0 * cross(self.spin, speed)
            + speed_rate,
        )


@dataclass(frozen=True)
class JointAxis:
    """What a joint's rates do, in the ground's frame: angular velocity and velocity of `place` per rate, (3, k)."""

    place: SX
    spin: SX
    speed: SX


@dataclass(frozen=True)
class Tree:
    """A model and its symbols.

    Parameters
    ----------
    model
        What it was made of.
    q, u, a
        Coordinates, rates and accelerations of all joints, columns in the model's order [rad, m, s].
    bodies
        Frames of the bodies by name, the ground among them.
    axes
        One for each joint, in the model's order.
    masses
        Symbols [kg] in place of the masses of some bodies; their inertia stays.
    centres, inertias
        Likewise of mass centres in the body's frame [m] and of inertias about them, in the body's axes [kg m²].
    gravity
        A symbol in place of the model's [m/s²], as where the ground is a body that turns.
    """

    model: Multibody
    q: SX
    u: SX
    a: SX
    bodies: dict[str, Moving]
    axes: tuple[JointAxis, ...]
    masses: Mapping[str, SX] = field(default_factory=dict)
    centres: Mapping[str, SX] = field(default_factory=dict)
    inertias: Mapping[str, SX] = field(default_factory=dict)
    gravity: SX | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return tuple(c.name for c in self.model.coordinates)

    def columns(self) -> list[slice]:
        """Where each joint's coordinates are among all."""
        ends = np.cumsum([0, *(len(joint.coordinates) for joint in self.model.joints)])
        return [slice(int(start), int(stop)) for start, stop in pairwise(ends)]

    def coupled(self) -> SX:
        """Coordinates in which those that depend on others are what these make them; `q` where none does."""
        from casadi import SX

        found = SX(self.q)
        for coupler in self.model.couplers:
            of = [self.names.index(name) for name in coupler.of]
            found[self.names.index(coupler.dependent)] = value_of(coupler.function, entries(found, of))
        return found

    def point(self, body: str, location: SX) -> SX:
        """A point of a body, given in its frame, in the ground's [m]."""
        from casadi import mtimes

        frame = self.bodies[body]
        return frame.place + mtimes(frame.rotation, location)


def tree_of(
    model: Multibody,
    *,
    masses: Mapping[str, SX] | None = None,
    centres: Mapping[str, SX] | None = None,
    inertias: Mapping[str, SX] | None = None,
    places: Mapping[str, SX] | None = None,
    gravity: SX | None = None,
) -> Tree:
    """A model in symbols.

    Parameters
    ----------
    masses, centres, inertias
        Of some bodies by name [kg, m, kg m²], symbols that equations are to be functions of.
    places
        Of some joints by name: their origin in the parent body [m], likewise.
    gravity
        Its acceleration in the ground's frame [m/s²], likewise.
    """
    from casadi import SX, mtimes

    apply_numpy()
    count = len(model.coordinates)
    q, u, a = (SX.sym(name, count) for name in "qua")
    still = SX(3, 1)
    bodies = {GROUND: Moving(SX.eye(3), still, still, still, still, still)}
    tree = Tree(model, q, u, a, bodies, ())
    moved = dict(places or {})
    axes = []
    for joint, columns in zip(model.joints, tree.columns(), strict=True):
        own = moving_joint(joint, *(entries(each, columns) for each in (q, u, a)))
        fixed = bodies[joint.parent].carried(joint.parent_offset, moved.get(joint.name))
        moving = fixed.moved(own)
        bodies[joint.child] = moving.carried(joint.child_offset.inv())
        rates = (mtimes(fixed.rotation, per) for per in (own.spin_per_rate, own.speed_per_rate))
        axes.append(JointAxis(moving.place, *rates))
    return Tree(
        model, q, u, a, bodies, tuple(axes), dict(masses or {}), dict(centres or {}), dict(inertias or {}), gravity
    )
