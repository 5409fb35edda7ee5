"""The keel without inertia: loads on its spheres, and its joints in equilibrium with the ground in every frame of a
motion.

Springs, dampers and friction of the joints, weight of the segments, spheres by `contact.sphere_foot` with damping and
friction. Without rates of the pose the frames do not know each other: elastic, without friction. With them each frame
is a step of a formula of second order for the joints, from the two before (`newton_kernel`); the first has joints at
rest.

Deviation from the law: the kinetic coefficient of friction holds at all speeds beyond the threshold. Where friction
falls with speed, from the static to the kinetic coefficient, a keel without inertia has several equilibria or jumps.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.on_tree import (
    InKeel,
    Planes,
    joint_numbers,
    plane_under,
    planes_under,
    rubbing_numbers,
    seen_by_keel,
)
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Ground
from geocontact.loads.sphere_set import SoleLaw, SphereLoads, sphere_loads

FIELDS = ("pressing", "force", "point", "centre", "normal", "depth")


def loads_at(
    keel: QuasiStaticKeel,
    angles: Float[np.ndarray, "t m"],
    speeds: Float[np.ndarray, "t m"],
    poses: RigidTransform,
    rate: Float[np.ndarray, "t 4 4"],
    ground: Ground,
) -> SphereLoads:
    """At angles [rad] and their rates [rad/s] of a keel, along poses `X_GK` and their derivative.

    Off a plane each segment is a rigid foot of its own, for `loads.sphere_set`; ValueError where a sphere is deeper
    than its radius there.
    """
    if isinstance(ground, HalfSpace):
        return keel.at(angles, speeds, poses, ground, rate).loads
    frames, segments = len(angles), np.array(keel.sole.segment)
    matrix, moving = poses.as_matrix().reshape(-1, 4, 4), np.asarray(rate)
    found: dict[str, Float[np.ndarray, ...]] = {}
    more = int(keel.keel.twists)
    for segment in range(keel.keel.joints + 1):
        if segment == 1 and more:
            step, slope = _hinge("x", angles[:, 0], speeds[:, 0], 0.0)
            matrix, moving = matrix @ step, moving @ step + matrix @ slope
        if segment:
            at, k = keel.keel.places[0] if segment == 1 else keel.keel.pitch, segment - 1 + more
            step, slope = _hinge("z", angles[:, k], speeds[:, k], at)
            matrix, moving = matrix @ step, moving @ step + matrix @ slope
        spheres, chosen = keel.sole.on(segment, keel.keel), segments == segment
        if spheres is None:
            continue
        law = replace(
            keel.law,
            stiffness=keel.law.stiffness[chosen],
            damping=keel.law.damping[chosen],
            static=np.broadcast_to(keel.law.static, len(segments))[chosen],
            kinetic=np.broadcast_to(keel.law.kinetic, len(segments))[chosen],
        )
        own = sphere_loads(spheres, law, RigidTransform.from_matrix(matrix), moving, ground)
        for name in FIELDS:
            values = getattr(own, name)
            if name not in found:
                found[name] = np.empty((frames, len(segments), *values.shape[2:]))
            found[name][:, chosen] = values
    return SphereLoads(**found)


def _hinge(
    axis: Literal["x", "z"], angle: Float[np.ndarray, " t"], speed: Float[np.ndarray, " t"], ahead: float
) -> tuple[Float[np.ndarray, "t 4 4"], Float[np.ndarray, "t 4 4"]]:
    """Pose of a segment in the one before, some way ahead of it [m] and turned about an axis, and its derivative."""
    step, slope = np.zeros((2, len(angle), 4, 4))
    step[:, :3, :3] = Rotation.from_euler(axis, angle[:, None]).as_matrix()
    step[:, 0, 3], step[:, 3, 3] = ahead, 1.0
    s, c = np.sin(angle) * speed, np.cos(angle) * speed
    i, j = (1, 2) if axis == "x" else (0, 1)
    slope[:, i, i], slope[:, i, j], slope[:, j, i], slope[:, j, j] = -s, -c, c, -s
    return step, slope


TOLERANCE = 1e-8
"""N m; torque about a joint that is left."""
SETTLED, ROUNDS = 1e-6, 30
"""m; by which a height above uneven ground may differ from that above the plane that is used; turns of both at most."""
OUTPUTS = 12
"""Numbers of a sphere: depth, its rate, pressing, force, centre, sliding."""
Array = np.ndarray
ChainArrays = tuple[Array, Array, Array, Array, Array, Array, Array, Array, Array, Array]
"""Springs, rest, axes, points, last, numbers, law, weights, centres and bearer of `balance_kernel.balance`."""
DOWNWARDS = (0.0, -9.80665, 0.0)
"""Gravity [m/s²] where y is up."""


@dataclass(frozen=True)
class KeelMotion:
    """The keel in each frame.

    Parameters
    ----------
    angles
        Of the joints, in the order of `on_tree.coordinates` [rad].
    loads
        Of the ground on each sphere, in the ground's frame.
    rate
        Of the depth of each sphere [m/s], 0 without rates of the pose.
    sliding
        Velocity of each sphere's lowest point along the ground, in its frame [m/s], likewise.
    steps
        Of Newton in each frame.
    """

    angles: Float[np.ndarray, "t m"]
    loads: SphereLoads
    rate: Float[np.ndarray, "t n"]
    sliding: Float[np.ndarray, "t n 3"]
    steps: Int[np.ndarray, " t"]

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the ground on the whole sole [N]."""
        return np.asarray(self.loads.force.sum(axis=1))


@dataclass(frozen=True)
class QuasiStaticKeel:
    """A keel at one fulcrum on its sole."""

    keel: Keel
    fulcrum: float
    sole: KeelSole
    law: SoleLaw

    def solve(
        self,
        poses: RigidTransform,
        ground: Ground,
        *,
        rate: Float[np.ndarray, "t 4 4"] | None = None,
        time: Float[np.ndarray, " t"] | None = None,
        gravity: tuple[float, float, float] = DOWNWARDS,
        start: Float[np.ndarray, " m"] | None = None,
    ) -> KeelMotion:
        """Along poses `X_GK` of the keel's frame in the ground's.

        Parameters
        ----------
        ground
            On uneven ground each sphere is on the plane that touches it where the sphere is nearest, found in turns.
        rate, time
            Time derivative of the poses (`loads.resultant`) and their times [s], both or neither.
        gravity
            In the ground's frame [m/s²].
        start
            Angles from which the first frame is sought; straight by default.

        ArithmeticError where a frame has no equilibrium that Newton's steps find, or a sphere no place on the ground.
        """
        if (rate is None) != (time is None):
            raise ValueError("rates of the poses and times are given both or neither")
        if isinstance(ground, HalfSpace):
            return self._on_planes(poses, plane_under(ground, poses), rate, time, gravity, start)
        spheres = self.sole.spheres
        centre = np.stack([poses.apply(each).reshape(-1, 3) for each in spheres.centre], axis=1)
        under = planes_under(ground, centre)
        for _ in range(ROUNDS):
            found = self._on_planes(poses, under, rate, time, gravity, start)
            under = planes_under(ground, found.loads.centre)
            height = np.einsum("tni,tni->tn", found.loads.centre, under.normal) - under.level
            off = np.abs(spheres.radius - found.loads.depth - height)
            near = np.minimum(height, spheres.radius - found.loads.depth) < spheres.radius
            if not (off[near] > SETTLED).any():
                return found
        raise ArithmeticError("a sphere finds no place on the ground")

    def _on_planes(
        self,
        poses: RigidTransform,
        under: Planes,
        rate: Float[np.ndarray, "t 4 4"] | None,
        time: Float[np.ndarray, " t"] | None,
        gravity: tuple[float, float, float],
        start: Float[np.ndarray, " m"] | None,
    ) -> KeelMotion:
        from geocontact.below_knee_prosthesis.keel.newton_kernel import solve_frames  # late: numba

        count = len(self.sole.spheres)
        seen = seen_by_keel(poses, under, gravity, rate, count)
        frames = len(seen.planes)
        per_time = np.zeros(frames) if time is None else np.concatenate([[0.0], 1.0 / np.diff(time)])
        joints = self.keel.hinges
        angles, left = np.empty((frames, joints)), np.empty(frames)
        outputs, steps = np.empty((frames, count, OUTPUTS)), np.zeros(frames, np.int64)
        found = solve_frames(
            np.zeros(joints) if start is None else np.asarray(start, float),
            per_time,
            *self.arrays(static=rate is None),
            seen.planes,
            seen.twists,
            seen.gravities,
            TOLERANCE,
            angles,
            outputs,
            left,
            steps,
        )
        if not found:
            bad = int(np.argmax(~(left <= TOLERANCE)))
            raise ArithmeticError(f"the keel has no equilibrium in frame {bad + 1}: {left[bad]:.3g} N m is left")
        return _results(angles, outputs, steps, seen, moving=rate is not None)

    def at(
        self,
        angles: Float[np.ndarray, "t m"],
        speeds: Float[np.ndarray, "t m"],
        poses: RigidTransform,
        ground: HalfSpace,
        rate: Float[np.ndarray, "t 4 4"],
    ) -> KeelMotion:
        """What the spheres do at given angles and their rates [rad/s], as of a simulation: nothing is sought.

        Friction with both coefficients of the law.
        """
        from geocontact.below_knee_prosthesis.keel.balance_kernel import balance  # late: numba

        count, joints = len(self.sole.spheres), angles.shape[1]
        seen = seen_by_keel(poses, plane_under(ground, poses), DOWNWARDS, rate, count)
        outputs = np.empty((len(angles), count, OUTPUTS))
        torque, slope, memory = np.empty(joints), np.empty((joints, joints)), np.zeros((2, joints))
        arrays = self.arrays(static=False, falling=True)
        for i, (y, u) in enumerate(zip(angles, speeds, strict=True)):
            at = seen.planes[i], seen.twists[i], seen.gravities[i]
            balance(y, y - u, 1.0, arrays[0], memory, *arrays[1:], *at, torque, slope, outputs[i])
        return _results(angles, outputs, np.zeros(len(angles), np.int64), seen, moving=True)

    def arrays(self, *, static: bool, falling: bool = False) -> ChainArrays:
        """Springs, joints, spheres, law and weights as the kernel takes them.

        Parameters
        ----------
        static
            Without damping and friction.
        falling
            Whether friction falls from the static to the kinetic coefficient.
        """
        keel, spheres, law, more = self.keel, self.sole.spheres, self.law, int(self.keel.twists)
        forward, right = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
        places = np.concatenate([keel.places[:more], keel.places])
        axes = np.array([forward] * more + [right] * keel.joints)
        segment = np.array(self.sole.segment)
        last = np.where(segment > 0, segment - 1 + more, -1).astype(np.int64)
        moving = 0.0 if static else 1.0
        numbers = np.stack(
            [
                spheres.radius,
                law.stiffness,
                moving * law.damping,
                moving * (law.static if falling else law.kinetic),
                moving * law.kinetic,
            ],
            axis=1,
        )
        shared = np.array([law.exponent, law.full_depth, law.threshold_speed])
        weights = np.full(keel.joints, keel.segment_mass)
        middles = (keel.places + 0.5 * keel.pitch)[:, None] * forward
        bearer = np.arange(keel.joints, dtype=np.int64) + more
        pairs = (joint_numbers, rubbing_numbers)
        springs = np.array([each for pair in pairs for each in pair(keel, self.fulcrum)])
        springs[2:4] *= moving
        return (
            springs, places[:, None] * forward, axes, spheres.centre.astype(float), last, numbers, shared,
            weights, middles, bearer,
        )  # fmt: skip


def _results(
    angles: Float[np.ndarray, "t m"],
    outputs: Float[np.ndarray, "t n outputs"],
    steps: Int[np.ndarray, " t"],
    seen: InKeel,
    *,
    moving: bool,
) -> KeelMotion:
    """From the keel's frame to the ground's."""
    depth, rate, pressing = outputs[..., 0], outputs[..., 1], outputs[..., 2]
    own = outputs[..., 3:].reshape(*depth.shape, 3, 3)
    force, arm, sliding = np.moveaxis(np.einsum("tij,tnkj->tnki", seen.rotation, own), 2, 0)
    centre = arm + seen.origin[:, None]
    height = np.einsum("tnj,tnj->tn", outputs[..., 6:9], seen.planes[..., :3]) + seen.planes[..., 3]
    touching = (depth > 0.0)[..., None]
    point = np.where(touching, centre - height[..., None] * seen.upwards, np.nan)
    normal = np.where(touching, seen.upwards, np.nan)
    loads = SphereLoads(pressing, force, point, centre, normal, depth)
    moved = float(moving)
    return KeelMotion(angles, loads, moved * rate, moved * sliding, steps)
