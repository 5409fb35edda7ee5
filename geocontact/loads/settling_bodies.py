"""Energy of several bodies that press on each other at once, each on an elastic layer, with its derivatives.

A pair's energy U depends on the pose of its rigid body m in the layer's body f alone (`loads.foundation`). With a
displacement a of a point and a turn b about it for each of the two bodies, in the common frame, and r from f's point to
m's, m moves in f to second order by

    a = a_m - a_f - b_f x (r + a_m - a_f) + b_f x (b_f x r)/2,   b = b_m - b_f - b_f x b_m / 2

which is exp(-b_f) applied to m's displacement and turn (Baker, Campbell and Hausdorff to second order). The chain rule
turns U's slope and stiffness into those of both bodies: action and reaction follow. Coordinates of each body are
those of `settling_potential` along given axes; a force stays along them and acts at the body's point. No friction.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.surface import Surface
from geocontact.loads.foundation import FoundationState, Layer, foundation_state
from geocontact.loads.settling import FACETED, Rest, least_energy, not_held, scales
from geocontact.loads.settling_potential import coordinates_of, placed_at, poses_of

COORDINATES = ("tx", "ty", "tz", "ry", "rx", "rz")
"""Displacements of a body's point along x, y, z of its axes, and turns R = Ry Rx Rz, as in `settling_potential`."""


@dataclass(frozen=True, eq=False)
class PressedPair:
    """A layer and the rigid body that presses into it.

    Parameters
    ----------
    layer, fixed
        The layer in the frame of its body, and that body's name.
    surface, normals, moving
        The rigid closed body with its `corner_normals`, and its name.
    """

    layer: Layer
    fixed: str
    surface: Surface
    normals: Float[np.ndarray, "m 3 3"]
    moving: str


@dataclass(frozen=True, eq=False)
class FreeBody:
    """A body that comes to rest.

    Parameters
    ----------
    point
        Point of it, in its frame, that displacements are of and the force acts at [m].
    free
        Which of `COORDINATES` settle; the others stay.
    force
        Force along the axes [N].
    springs
        Stiffness of each coordinate [N/m, N m/rad], 0 without; at rest where the motion is.
    """

    point: Float[np.ndarray, " 3"]
    free: Bool[np.ndarray, " 6"]
    force: Float[np.ndarray, " 3"]
    springs: Float[np.ndarray, " 6"]


@dataclass(frozen=True, eq=False)
class BodiesEnergy:
    """Energy of all pairs, springs and forces at the coordinates of all free bodies, six each in their order.

    Parameters
    ----------
    values
        The coordinates [m, rad].
    potential
        Stored energy and that of the forces [J].
    slope, stiffness
        First and second derivative to the coordinates.
    states
        State of each pair's layer.
    """

    values: Float[np.ndarray, " n"]
    potential: float
    slope: Float[np.ndarray, " n"]
    stiffness: Float[np.ndarray, "n n"]
    states: tuple[FoundationState, ...]


@dataclass(frozen=True, eq=False)
class Assembly:
    """All bodies of one frame of a motion.

    Parameters
    ----------
    pairs
        What presses.
    poses
        Pose of each body in the common frame as it was recorded.
    axes
        Pose in the common frame of the axes of each free body.
    bodies
        The free bodies by name.
    """

    pairs: Sequence[PressedPair]
    poses: Mapping[str, RigidTransform]
    axes: Mapping[str, RigidTransform]
    bodies: Mapping[str, FreeBody]

    @property
    def recorded(self) -> Float[np.ndarray, " n"]:
        """Coordinates of the free bodies where the motion has them."""
        own = [self.axes[name].inv() * self.poses[name] for name in self.bodies]
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Gimbal lock")  # `turned_too_far` finds where that matters
            values = [
                coordinates_of(pose, one.point).ravel() for pose, one in zip(own, self.bodies.values(), strict=True)
            ]
        return np.concatenate(values)

    @property
    def free(self) -> Bool[np.ndarray, " n"]:
        """Which of the coordinates settle."""
        return np.concatenate([one.free for one in self.bodies.values()])

    @property
    def load(self) -> float:
        """Smallest force on a body that bears one [N]; 0 where none does."""
        sizes = [float(np.linalg.norm(one.force)) for one in self.bodies.values()]
        return min((size for size in sizes if size > 0.0), default=0.0)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of all coordinates: "femur ty"."""
        return tuple(f"{name} {coordinate}" for name in self.bodies for coordinate in COORDINATES)

    def borne(self, total: BodiesEnergy) -> Float[np.ndarray, " b"]:
        """What each free body bears [N]: its own force, or a larger one of a single contact."""
        found = [float(np.linalg.norm(one.force)) for one in self.bodies.values()]
        for pair, state in zip(self.pairs, total.states, strict=True):
            force = float(np.linalg.norm(state.slope[:3]))
            for k, name in enumerate(self.bodies):
                if name in (pair.moving, pair.fixed):
                    found[k] = max(found[k], force)
        return np.array(found)

    def residuals(self, total: BodiesEnergy) -> Float[np.ndarray, " b"]:
        """Largest residual force along a free coordinate of each free body, moments over 20 mm [N]."""
        left = np.where(self.free, np.abs(total.slope * scales(len(total.slope))), 0.0)
        return np.asarray(left.reshape(-1, 6).max(axis=1))

    def at_rest(self, total: BodiesEnergy) -> bool:
        """Whether the residual force of every free body is small beside what that body bears."""
        return bool((self.residuals(total) <= FACETED * self.borne(total)).all())

    def loose(self, total: BodiesEnergy) -> tuple[str, ...]:
        """Coordinates that nothing holds, each body's stiffness measured by what that body bears.

        None where no force acts and nothing presses: the bodies stay where they are.
        """
        borne = self.borne(total)
        most = max(self.load, float(borne.max()))
        if most == 0.0:
            return ()
        size = np.repeat(np.where(borne > 0.0, borne, most), 6) ** -0.5
        return not_held(total.stiffness * np.outer(size, size), self.free, 1.0, self.coordinates)

    def placed(self, values: Float[np.ndarray, " n"]) -> dict[str, RigidTransform]:
        """Pose of every body in the common frame at these coordinates."""
        found = dict(self.poses)
        for k, (name, one) in enumerate(self.bodies.items()):
            found[name] = self.axes[name] * poses_of(values[6 * k : 6 * k + 6][None], one.point)[0]
        return found

    def at(self, values: Float[np.ndarray, " n"]) -> BodiesEnergy:
        """Energy and its derivatives."""
        poses, names = self.placed(values), list(self.bodies)
        slope, stiffness = np.zeros(len(values)), np.zeros((len(values), len(values)))
        states, potential = [], 0.0
        for pair in self.pairs:
            about = {name: self.bodies[name].point if name in self.bodies else np.zeros(3) for name in poses}
            state, g, h = _of_pair(pair, poses, about)
            states.append(state)
            potential += state.energy
            both = [(names.index(name), part) for part, name in enumerate((pair.moving, pair.fixed)) if name in names]
            for k, part in both:
                slope[6 * k : 6 * k + 6] += g[6 * part : 6 * part + 6]
                for j, other in both:
                    block = h[6 * part : 6 * part + 6, 6 * other : 6 * other + 6]
                    stiffness[6 * k : 6 * k + 6, 6 * j : 6 * j + 6] += block
        slope, stiffness = self._to_coordinates(values, slope, stiffness)
        off = values - self.recorded
        for k, one in enumerate(self.bodies.values()):
            six = slice(6 * k, 6 * k + 6)
            stretched = one.springs * off[six]
            potential += 0.5 * float(stretched @ off[six]) - float(one.force @ values[six][:3])
            slope[six] += stretched - np.concatenate([one.force, np.zeros(3)])
            stiffness[six, six] += np.diag(one.springs)
        return BodiesEnergy(values, potential, slope, stiffness, tuple(states))

    def _to_coordinates(
        self, values: Float[np.ndarray, " n"], slope: Float[np.ndarray, " n"], stiffness: Float[np.ndarray, "n n"]
    ) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "n n"]]:
        """Derivatives to displacements and turns in the common frame as derivatives to the coordinates."""
        jacobian = np.zeros_like(stiffness)
        more = np.zeros_like(stiffness)
        for k, (name, one) in enumerate(self.bodies.items()):
            six = slice(6 * k, 6 * k + 6)
            turn = self.axes[name].rotation.as_matrix()
            at = placed_at(values[six], one.point)
            jacobian[six, six][:3, :3], jacobian[six, six][3:, 3:] = turn, turn @ at.turns.T
            own = np.concatenate([turn.T @ slope[six][:3], turn.T @ slope[six][3:]])
            more[six, six] = at.to_coordinates(own, np.zeros((6, 6)))[1]
        return jacobian.T @ slope, jacobian.T @ stiffness @ jacobian + more


def _of_pair(
    pair: PressedPair, poses: Mapping[str, RigidTransform], points: Mapping[str, Float[np.ndarray, " 3"]]
) -> tuple[FoundationState, Float[np.ndarray, " 12"], Float[np.ndarray, "12 12"]]:
    """State in FIXED's frame; slope and stiffness to displacement and turn of MOVING and of FIXED, common frame."""
    base, own = poses[pair.fixed], poses[pair.fixed].inv() * poses[pair.moving]
    about = own.apply(points[pair.moving])
    state = foundation_state(
        pair.layer, pair.surface, pair.normals, own.rotation.as_matrix(), np.asarray(own.translation), about
    )
    turn = np.kron(np.eye(2), base.rotation.as_matrix())
    slope, stiffness = turn @ state.slope, turn @ state.stiffness @ turn.T
    r = base.rotation.apply(about - points[pair.fixed])
    first = np.zeros((6, 12))
    first[:, :6], first[:, 6:] = np.eye(6), -np.eye(6)
    first[:3, 9:] = _cross(r)
    force, moment = _cross(slope[:3]), _cross(slope[3:])
    along = np.outer(slope[:3], r)
    second = np.zeros((12, 12))
    second[:3, 9:], second[6:9, 9:], second[3:6, 9:] = -force, force, -0.5 * moment
    second += second.T
    second[9:, 9:] += 0.5 * (along + along.T) - np.trace(along) * np.eye(3)
    return state, first.T @ slope, first.T @ stiffness @ first + second


def _cross(a: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """[a] with [a] b = a x b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


UPRIGHT = np.radians(80.0)
"""The turn about x up to which turns about y and z are two: at a right angle they are one."""


def settled(assembly: Assembly, start: Float[np.ndarray, " n"]) -> Rest[BodiesEnergy]:
    """All free bodies at rest, from these coordinates: first along their forces alone, then along all that is free."""
    along = np.concatenate([np.r_[one.force != 0.0, np.zeros(3, bool)] for one in assembly.bodies.values()])
    free, at = assembly.free, start
    if (free & along).any():
        at = least_energy(assembly.at, at, free & along, assembly.load).total.values
    rest = least_energy(assembly.at, at, free, assembly.load)
    return replace(rest, converged=assembly.at_rest(rest.total))


def turned_too_far(assembly: Assembly, values: Float[np.ndarray, " n"]) -> str | None:
    """A body whose coordinates mean little, because its turn about x leaves the other two hardly apart; None without.

    They do where both others settle; and where rx does, from there: its axis is turned by ry. A turn about y alone is
    about y of the axes and one about z alone about z of the body, however it lies.
    """
    ry, rx, rz = (COORDINATES.index(name) for name in ("ry", "rx", "rz"))
    start = assembly.recorded
    for k, (name, one) in enumerate(assembly.bodies.items()):
        at = values if one.free[ry] and one.free[rz] else start
        if (one.free[rx] or at is values) and abs(at[6 * k + rx]) > UPRIGHT:
            return name
    return None
