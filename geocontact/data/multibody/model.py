"""Rigid bodies on joints: masses, joints from the ground outwards, markers, gravity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.joint import Coordinate, JointFunction, JointModel


@dataclass(frozen=True)
class CoordinateLimit:
    """A spring and a dashpot that act beyond the limits of a coordinate (OpenSim's `CoordinateLimitForce`).

    Parameters
    ----------
    coordinate
        Its name.
    upper, lower
        Limits [rad, m].
    upper_stiffness, lower_stiffness
        Of the springs far beyond the limits [N m/rad, N/m].
    damping
        Of the dashpot there [N m s/rad, N s/m].
    transition
        How far beyond a limit they reach their full size [rad, m].
    """

    name: str
    coordinate: str
    upper: float
    lower: float
    upper_stiffness: float
    lower_stiffness: float
    damping: float
    transition: float


@dataclass(frozen=True)
class CoordinateSpring:
    """A spring and a dashpot along a coordinate (OpenSim's `SpringGeneralizedForce`).

    Parameters
    ----------
    stiffness
        [N m/rad, N/m].
    rest
        Where the spring is slack [rad, m].
    viscosity
        [N m s/rad, N s/m].
    """

    name: str
    coordinate: str
    stiffness: float
    rest: float
    viscosity: float


@dataclass(frozen=True)
class FrameBushing:
    """Springs and dashpots between frames of two bodies (OpenSim's `BushingForce`).

    Parameters
    ----------
    bodies
        Names of the first and the second.
    frames
        Poses of the frames in them.
    stiffness, damping
        Three along the Cardan angles (x, y', z'') of the second frame in the first [N m/rad, N m s/rad], three along
        its translation in the first frame's axes [N/m, N s/m].
    """

    name: str
    bodies: tuple[str, str]
    frames: tuple[RigidTransform, RigidTransform]
    stiffness: Float[np.ndarray, " 6"]
    damping: Float[np.ndarray, " 6"]


PassiveForce = CoordinateLimit | CoordinateSpring | FrameBushing


@dataclass(frozen=True)
class PassiveForces:
    """Those of a model.

    Parameters
    ----------
    acting
        That count.
    excluded
        Names of those that were asked to be left out.
    unread
        Kind and name of forces that would act as well, of kinds that are not read.
    """

    acting: tuple[PassiveForce, ...] = ()
    excluded: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()


GROUND = "ground"


@dataclass(frozen=True)
class Body:
    """A rigid body.

    Parameters
    ----------
    name
        As joints and markers call it.
    mass
        [kg]; 0 for a body that only carries frames.
    centre
        Mass centre in the body's frame [m].
    inertia
        About the mass centre, in the body's axes [kg m^2], symmetric.
    """

    name: str
    mass: float
    centre: Float[np.ndarray, " 3"]
    inertia: Float[np.ndarray, "3 3"]


@dataclass(frozen=True)
class Marker:
    """A point fixed to a body.

    Parameters
    ----------
    location
        In the body's frame [m].
    fixed
        Whether it is to stay there when markers are moved to where a subject had them.
    direction
        Whether it was recorded as a direction, from the body's origin in the ground's axes, and not as a place: an
        orientation is three of them.
    """

    name: str
    body: str
    location: Float[np.ndarray, " 3"]
    fixed: bool = False
    direction: bool = False


@dataclass(frozen=True)
class PointPair:
    """Points of two bodies that a constraint keeps together, as at a joint that closes a loop.

    Parameters
    ----------
    bodies
        Names of both; one may be the ground.
    places
        In the frames of the bodies [m].
    """

    name: str
    bodies: tuple[str, str]
    places: Float[np.ndarray, "2 3"]

    def ends(self, which: int) -> tuple[str, Float[np.ndarray, " 3"]]:
        """Body and place of one of them."""
        return self.bodies[which], self.places[which]


@dataclass(frozen=True)
class Coupler:
    """A coordinate that is a function of others, as that of a patella is of the knee's.

    Parameters
    ----------
    dependent
        Name of the coordinate.
    of
        Names of those it depends on.
    function
        Its value [rad, m] from theirs.
    """

    dependent: str
    of: tuple[str, ...]
    function: JointFunction


@dataclass(frozen=True)
class Multibody:
    """A tree of bodies.

    Parameters
    ----------
    name
        For the record.
    bodies
        All but the ground.
    joints
        One for each body, parents before children.
    markers
        Points fixed to bodies.
    gravity
        Its acceleration in the ground's frame [m/s^2].
    couplers
        In an order in which each depends on independent coordinates and on those of couplers before it.
    pairs
        Points that belong together: inverse kinematics keeps them so, nothing else does.
    """

    name: str
    bodies: tuple[Body, ...]
    joints: tuple[JointModel, ...]
    markers: tuple[Marker, ...]
    gravity: Float[np.ndarray, " 3"]
    couplers: tuple[Coupler, ...] = ()
    pairs: tuple[PointPair, ...] = ()

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Generalised coordinates of all joints, in the joints' order."""
        return tuple(c for joint in self.joints for c in joint.coordinates)

    def coupled(self, values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
        """Rows of coordinates [rad, m] in which those that depend on others are what these make them."""
        found = values.copy()
        column = {c.name: k for k, c in enumerate(self.coordinates)}
        for coupler in self.couplers:
            found[:, column[coupler.dependent]] = coupler.function(found[:, [column[name] for name in coupler.of]])
        return found

    @property
    def mass(self) -> float:
        """Mass of all bodies [kg]."""
        return sum(body.mass for body in self.bodies)

    @property
    def weight(self) -> float:
        """Weight of all bodies [N]."""
        return self.mass * float(np.linalg.norm(self.gravity))

    @property
    def up(self) -> Float[np.ndarray, " 3"]:
        """Unit vector against gravity in the ground's frame; y where there is no gravity."""
        size = float(np.linalg.norm(self.gravity))
        return np.array([0.0, 1.0, 0.0]) if size == 0.0 else np.asarray(0.0 - self.gravity / size)

    def poses(self, values: Float[np.ndarray, "t n"]) -> dict[str, RigidTransform]:
        """Poses of the bodies in the ground, one for each row of coordinates [rad, m]; the ground's own among them."""
        frames = len(values)
        q = {c.name: column for c, column in zip(self.coordinates, values.T, strict=True)}
        still = RigidTransform.from_translation(np.zeros((frames, 3)))
        found = {GROUND: still}
        for joint in self.joints:
            found[joint.child] = found[joint.parent] * joint.pose(q, frames)
        return found

    def marker_places(self, values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t m 3"]:
        """Where the markers are in the ground's frame [m], one row for each row of coordinates [rad, m]."""
        poses = self.poses(values)
        places = [poses[m.body].apply(m.location) for m in self.markers]
        return np.stack(places, axis=1) if places else np.zeros((len(values), 0, 3))

    def mass_centre(self, values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t 3"]:
        """Mass centre of all bodies, in the ground's frame [m], one row for each row of coordinates [rad, m]."""
        poses = self.poses(values)
        places = [
            body.mass / self.mass * poses[body.name].apply(body.centre) for body in self.bodies if body.mass > 0.0
        ]
        return np.asarray(np.sum(places, axis=0)) if places else np.zeros((len(values), 3))


def outwards(joints: tuple[JointModel, ...]) -> tuple[tuple[JointModel, ...], tuple[JointModel, ...]]:
    """Joints in the order in which they lead away from the ground, and those that never do (a loop, a lost parent).

    One whose child is reached first is turned round, as OpenSim 4 has joints that OpenSim 3 calls reversed.
    """
    reached, order, waiting = {GROUND}, [], list(joints)
    while waiting:
        found = [joint for joint in waiting if (joint.parent in reached) != (joint.child in reached)]
        if not found:
            break
        first = next((joint for joint in found if joint.parent in reached), found[0])
        order.append(first if first.parent in reached else first.turned_round())
        reached.add(order[-1].child)
        waiting.remove(first)
    return tuple(order), tuple(waiting)


def coupler_stretch(model: Multibody, dependent: str, factors: Mapping[str, Float[np.ndarray, " 3"]]) -> float:
    """How much a dependent coordinate that is a shift grows where bodies do by these factors; 1 for an angle."""
    for joint in model.joints:
        for slot, axis in enumerate(joint.axes):
            if slot >= 3 and axis.coordinates == (dependent,) and joint.base in factors:
                return joint.stretch(slot, factors[joint.base])
    return 1.0
