"""What a foot does at a pitch and under a load, from many feet pressed against the ground, and a foot that carries it.

Quasi-static, elastic and upright in the frontal plane: then a foot is a function of its pitch, its load and the force
along the ground, and a stance is a path on that table. Solving the keel along one stance for a load costs as much as
the whole table, from which every kinematic draw is read for next to nothing. Between the rows it is linear.

The force along the ground bends the keel as well, for it acts below its joints: a fifth of the load in push-off adds a
quarter to what a keel stores. Each sphere has its share of it, as it has of the load. Its effect is tabulated for a
fifth of the load forwards, and taken as linear in the force.

`FootMap` read the other way round. Between its rows of pitch heights are linear, and so they are between its loads, so
that the load of a height is exact; beyond the last load of a row the foot is as stiff as before it.

People neither keep their angles on another foot nor their torques; what they do is taken to lie between. With the
angles kept the socket turns as recorded and the leg, free upwards, finds the height at which the load is carried. With
the torque kept the foot turns until the load acts about the ankle with the moment that it had on the recorded foot.
Both are quasi-static: the recorded load is kept, which with a pelvis that is free upwards is nearly so. Torques kept in
hip and knee are `joint_torques_kept`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.interpolate import RegularGridInterpolator
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.design.foot_task import LEVEL, FootTask, Terrain, thigh_direction
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.loads.centre_of_pressure import GROUND_POINT, centre_of_pressure


@dataclass(frozen=True, eq=False)
class FeetOnGround:
    """Maps with the same rows.

    Parameters
    ----------
    pitch, load
        Of the rows [rad, N].
    table
        Height, centre of pressure along x and y [m] of each foot.
    """

    pitch: Float[np.ndarray, " p"]
    load: Float[np.ndarray, " l"]
    table: Float[np.ndarray, "n p l c"]

    def height(self, pitch: Float[np.ndarray, " n"], load: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """At which each foot bears a load [m]."""
        rows = self._rows(pitch)[..., 0]
        at = np.clip(np.searchsorted(self.load, load) - 1, 0, len(self.load) - 2)
        return _between(rows, at, (load - self.load[at]) / self.load[1])

    def borne(
        self, pitch: Float[np.ndarray, " n"], height: Float[np.ndarray, " n"]
    ) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "n 2"]]:
        """Load [N], 0 above the ground, and centre of pressure in each keel's frame [m]."""
        rows = self._rows(pitch)
        at = np.clip((rows[..., 0] >= height[:, None]).sum(axis=1) - 1, 0, len(self.load) - 2)
        n = np.arange(len(at))
        first, second = rows[n, at], rows[n, at + 1]
        fall = np.maximum(first[:, 0] - second[:, 0], LEAST)
        share = np.maximum((first[:, 0] - height) / fall, 0.0)
        inside = np.minimum(share, 1.0)[:, None]
        return (at + share) * self.load[1], first[:, 1:] + inside * (second - first)[:, 1:]

    def _rows(self, pitch: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n l c"]:
        step = self.pitch[1] - self.pitch[0]
        place = np.clip((pitch - self.pitch[0]) / step, 0.0, len(self.pitch) - 1.0)
        at = np.minimum(place.astype(int), len(self.pitch) - 2)
        n, share = np.arange(len(at)), (place - at)[:, None, None]
        return np.asarray((1.0 - share) * self.table[n, at] + share * self.table[n, at + 1])


LEAST = 1e-9
"""m; by which a foot sinks from one row of loads to the next, at least."""


def feet_on_ground(maps: Sequence[FootMap]) -> FeetOnGround:
    """Feet of maps whose rows are the same; ValueError for others."""
    first = maps[0]
    if any(each.pitch is not first.pitch and not np.array_equal(each.pitch, first.pitch) for each in maps):
        raise ValueError("the maps have other rows")
    return FeetOnGround(first.pitch, first.load, np.stack([each.table[..., :PLACES] for each in maps]))


def _between(rows: Float[np.ndarray, "n l"], at: np.ndarray, share: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    n = np.arange(len(at))
    return np.asarray(rows[n, at] + share * (rows[n, at + 1] - rows[n, at]))


PITCHES, LOADS, DEPTHS = np.radians(2.0), 21, 16
"""Step of pitch [rad], rows of load, and depths that each pitch is pressed to."""
SHALLOW, DEEPER, DEEPEST, ROUNDS, PROBES = 12e-3, 1.4, 0.12, 14, 5
"""m; first depth that is tried, factor to the next, most of all, how often, and steps from the air to it."""
NEAR, LOWERED = 1e-6, 100
"""m; to which the height of touching is found, and how often the foot is lowered at most."""
DRAG, SLIPS = 0.2, 0.4
"""Force along the ground over the load: that of the second table, and the most that is read."""
FURTHER = 1.1
"""Share of the depths: those of the second table, whose keel gives more under a load."""
SLIDING = 1.0
"""m/s; at which the second table's feet slide, so that friction is what is wanted on every sphere."""
MARGIN = 1.05
"""Share of the loads of a stance, beyond them."""
PLACES = 3
"""Channels before the angles of the joints: height, and centre of pressure along x and y of the keel's frame."""


@dataclass(frozen=True, eq=False)
class FootMap:
    """A foot at one fulcrum over pitch and load.

    Parameters
    ----------
    pitch
        Toes up [rad].
    load
        [N].
    table
        Height of the keel's origin [m], centre of pressure along x and y of the keel's frame [m], joint angles [rad].
    dragged
        What a force along the ground adds, over its share of the load, forwards positive.
    """

    keel: QuasiStaticKeel
    pitch: Float[np.ndarray, " p"]
    load: Float[np.ndarray, " l"]
    table: Float[np.ndarray, "p l c"]
    dragged: Float[np.ndarray, "p l c"]

    def at(
        self,
        pitch: Float[np.ndarray, "*s"],
        load: Float[np.ndarray, "*s"],
        forward: Float[np.ndarray, "*s"] | None = None,
    ) -> Float[np.ndarray, "*s c"]:
        """The table's channels; pitches beyond its ends are those of its ends.

        `forward` is the force along the ground [N]: none by default.
        """
        inside = np.clip(pitch, self.pitch[0], self.pitch[-1]), np.clip(load, self.load[0], self.load[-1])
        places = np.stack(inside, axis=-1)
        found = np.asarray(RegularGridInterpolator((self.pitch, self.load), self.table)(places))
        if forward is None:
            return found
        share = np.clip(np.divide(forward, np.maximum(load, 1.0)), -SLIPS, SLIPS)
        more = RegularGridInterpolator((self.pitch, self.load), self.dragged)(places)
        return np.asarray(found + share[..., None] * more)

    def stored(self, channels: Float[np.ndarray, "*s c"]) -> Float[np.ndarray, "*s"]:
        """Energy of the keel's springs [J]."""
        return np.asarray(0.5 * channels[..., PLACES:] ** 2 @ self.keel.keel.stiffness(self.keel.fulcrum))


def foot_map(
    keel: QuasiStaticKeel, pitch: Float[np.ndarray, " p"], most: Float[np.ndarray, " p"], terrain: Terrain = LEVEL
) -> FootMap:
    """At increasing pitches [rad] against the ground, each up to a load [N].

    Above it the table stays at what it is, but for the height, which falls on as it did.


    ArithmeticError where the foot does not reach a load, or the keel has no equilibrium on the way.
    """
    load, depth = np.linspace(0.0, float(most.max()), LOADS), _deep_enough(keel, pitch, most, terrain)
    table = _tabulated(keel, pitch, load, depth, terrain, 0.0)
    second = _tabulated(keel, pitch, load, FURTHER * depth, terrain, DRAG)
    return FootMap(keel, pitch, load, table, (second - table) / DRAG)


def _tabulated(
    keel: QuasiStaticKeel,
    pitch: Float[np.ndarray, " p"],
    load: Float[np.ndarray, " l"],
    depth: Float[np.ndarray, " p"],
    terrain: Terrain,
    drag: float,
) -> Float[np.ndarray, "p l c"]:
    """The channels at the rows of load, of feet pressed to their depths."""
    motion, poses, shape = _pressed(keel, pitch, depth, DEPTHS, terrain, drag)
    centre = poses.inv().apply(centre_of_pressure(motion.loads, GROUND_POINT).centre)
    channels = np.column_stack([poses.translation[:, 1], centre[:, :2], motion.angles]).reshape(*shape, -1)
    force = motion.force[:, 1].reshape(shape)
    force = np.maximum.accumulate(force, axis=1)
    table = np.empty((len(pitch), LOADS, channels.shape[-1]))
    for k, (pressing, of) in enumerate(zip(force, channels, strict=True)):
        known = np.isfinite(of).all(axis=1) & (pressing > 0.0)
        for channel in range(table.shape[2]):
            table[k, :, channel] = np.interp(load, pressing[known], of[known, channel])
        _further(table[k, :, 0], load, pressing[known][-1])
    return table


def _further(height: Float[np.ndarray, " l"], load: Float[np.ndarray, " l"], last: float) -> None:
    """Heights beyond the last load that was reached go on along a straight line."""
    known = int(np.searchsorted(load, last, side="right")) - 1
    if 1 <= known < len(load) - 1:
        height[known + 1 :] = height[known] + (load[known + 1 :] - load[known]) * (
            (height[known] - height[known - 1]) / (load[known] - load[known - 1])
        )


def needed(
    pitch: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"], reach: float
) -> tuple[Float[np.ndarray, " p"], Float[np.ndarray, " p"]]:
    """Rows of pitch for a stance that may be turned by up to `reach` [rad] in any frame, and loads for them."""
    lowest, highest = float(pitch.min()) - reach, float(pitch.max()) + reach
    rows = np.linspace(lowest, highest, max(2, 1 + int(np.ceil((highest - lowest) / PITCHES))))
    near = np.abs(pitch[:, None] - rows) <= reach + PITCHES
    return rows, MARGIN * np.where(near, load[:, None], 0.0).max(axis=0)


def _deep_enough(
    keel: QuasiStaticKeel, pitch: Float[np.ndarray, " p"], most: Float[np.ndarray, " p"], terrain: Terrain
) -> Float[np.ndarray, " p"]:
    """Depth of each row at which it carries its load [m]."""
    depth = np.full(len(pitch), SHALLOW)
    for _ in range(ROUNDS):
        motion, _, shape = _pressed(keel, pitch, depth, PROBES, terrain, 0.0)
        force = motion.force[:, 1].reshape(shape).max(axis=1)
        if (force >= most).all():
            return depth
        wanted = np.where(force > 0.2 * most, most / np.maximum(force, 1.0) * 1.05, DEEPER)
        depth = np.where(force < most, np.minimum(depth * np.clip(wanted, 1.05, DEEPER), DEEPEST), depth)
    raise ArithmeticError("the foot does not reach a load of the stance")


def _pressed(
    keel: QuasiStaticKeel,
    pitch: Float[np.ndarray, " p"],
    deepest: Float[np.ndarray, " p"],
    count: int,
    terrain: Terrain,
    drag: float,
) -> tuple[KeelMotion, RigidTransform, tuple[int, int]]:
    """Upright feet from the air to their depths below where each straight foot just touches.

    In that order, and from the air again at each pitch, so that of several equilibria the one is found that a foot
    comes to which is put down. The foremost spheres keep their place along the ground.
    """
    share = np.concatenate([[-0.1], np.linspace(0.0, 1.0, count + 1)[1:]])
    turn, spheres = Rotation.from_euler("z", pitch[:, None]), keel.sole.spheres
    held = spheres.centre[int(np.argmax(spheres.centre[:, 0]))]
    poses = terrain.standing(RigidTransform.from_components(np.zeros((len(pitch), 3)), turn), held)
    place = poses.translation.copy()
    place[:, 1] = _touching(keel, poses, terrain)
    place = np.repeat(place, len(share), axis=0)
    place[:, 1] -= (deepest[:, None] * share).ravel()
    pressed = RigidTransform.from_components(place, turn[np.repeat(np.arange(len(pitch)), len(share))])
    return solved_with_drag(keel, pressed, terrain, drag), pressed, (len(pitch), len(share))


def solved_with_drag(keel: QuasiStaticKeel, poses: RigidTransform, terrain: Terrain, drag: float) -> KeelMotion:
    """In equilibrium; with a drag, while all feet slide backwards on a sole of that friction without damping."""
    if not drag:
        return keel.solve(poses, terrain.ground)
    law, rate = keel.law, np.zeros((len(poses), 4, 4))
    rate[:, 0, 3] = -SLIDING
    rough = np.full(len(law.stiffness), drag)
    sole = replace(law, damping=0.0 * law.damping, static=rough, kinetic=rough)
    apart = 1e9 * np.arange(len(poses))  # s; joints that take so long from pose to pose have no rates
    return replace(keel, law=sole).solve(poses, terrain.ground, rate=rate, time=apart)


def _touching(keel: QuasiStaticKeel, poses: RigidTransform, terrain: Terrain) -> Float[np.ndarray, " t"]:
    """Height at which a straight foot just touches [m]: lowered by what it is clear of the ground, until it is not."""
    spheres, ground, up = keel.sole.spheres, terrain.ground, np.array([0.0, 1.0, 0.0])
    centres, height = np.stack([poses.apply(each) for each in spheres.centre], axis=1), np.ones(len(poses))
    for _ in range(LOWERED):
        moved = centres + height[:, None, None] * up
        distance = ground.proximity(moved.reshape(-1, 3)).distance.reshape(centres.shape[:2])
        clear = (distance - spheres.radius).min(axis=1)
        height -= clear
        if float(np.abs(clear).max()) < NEAR:
            break
    return height


REACH, STEP = np.radians(8.0), np.radians(0.1)
"""How far a foot is turned to keep a torque, and in which steps it is looked for [rad]."""


@dataclass(frozen=True, eq=False)
class CarriedLoad:
    """The foot along a stance.

    Parameters
    ----------
    tilt
        By which each frame is turned against the recorded one [rad], toes up.
    centre
        Of pressure, x and y in the keel's frame [m].
    angles
        Of the keel's joints [rad].
    stored
        Energy of the keel's springs [J].
    height
        Of the keel's origin above the floor [m].
    kept
        Share of the frames in which the wanted torque is reached.
    """

    task: FootTask
    foot: FootMap
    tilt: Float[np.ndarray, " t"]
    height: Float[np.ndarray, " t"]
    centre: Float[np.ndarray, "t 2"]
    angles: Float[np.ndarray, "t n"]
    stored: Float[np.ndarray, " t"]
    kept: float

    def moment(self, point: Float[np.ndarray, "*#t k"]) -> Float[np.ndarray, " t"]:
        """Moment of the ground's force about a point of the keel's frame, or one of each frame, in its sagittal
        plane [N m]; positive: toes up.
        """
        return _moment(self.task, self.centre, self.task.pitch + self.tilt, point)

    @property
    def ankle_moment(self) -> Float[np.ndarray, " t"]:
        """About the ankle [N m]."""
        return self.moment(self.task.ankle)

    @property
    def leg_levers(self) -> Float[np.ndarray, "t 2"]:
        """Moments of the ground's force about hip and knee [N m], to the left."""
        task, pitch = self.task, self.task.pitch + self.tilt
        hip = task.knee[:2] + task.leg.length * thigh_direction(task.thigh - pitch)
        return np.column_stack([self.moment(hip), self.moment(task.knee)])

    @property
    def leg_torques(self) -> Float[np.ndarray, "t 2"]:
        """Torques of hip and knee on thigh and shank [N m]: flexion of the hip and extension of the knee positive.

        Weight and inertia of the leg are those of `task.needed`, whatever `tilt` is.
        """
        return np.asarray(self.task.needed - self.leg_levers)

    @property
    def leg_angles(self) -> Float[np.ndarray, "t 2"]:
        """Turns of thigh against pelvis and of shank against thigh [rad]."""
        task = self.task
        return np.column_stack([task.thigh - task.pelvis, task.pitch + self.tilt - task.thigh])

    def with_torques(self, torques: Float[np.ndarray, "t 2"]) -> CarriedLoad:
        """The same, hip and knee having these [N m]."""
        return replace(self, task=replace(self.task, needed=torques + self.leg_levers))


def carried(foot: FootMap, task: FootTask, tilt: Float[np.ndarray, " t"], kept: float) -> CarriedLoad:
    """The foot turned by that much against the stance [rad], toes up."""
    channels = foot.at(task.pitch + tilt, task.load, task.forward)
    return CarriedLoad(
        task, foot, tilt, channels[:, 0], channels[:, 1:PLACES], channels[:, PLACES:], foot.stored(channels), kept
    )


def with_angles_kept(foot: FootMap, task: FootTask) -> CarriedLoad:
    """The socket turns as recorded."""
    return carried(foot, task, np.zeros(len(task.time)), 1.0)


def with_torque_kept(foot: FootMap, task: FootTask, moment: Float[np.ndarray, " t"]) -> CarriedLoad:
    """The foot turns, as little as it must, until the ankle has that moment [N m]; where it cannot, as near as it can.

    The moment falls as the toes go up, so that there is one such turn where there is any.
    """
    tilt = np.arange(-REACH, REACH + 0.5 * STEP, STEP)
    pitch = task.pitch[:, None] + tilt
    load, forward = (np.broadcast_to(each[:, None], pitch.shape) for each in (task.load, task.forward))
    channels = foot.at(pitch, load, forward)
    off = _moment(task, channels[..., 1:PLACES], pitch, task.ankle) - moment[:, None]
    crossing = np.signbit(off[:, :-1]) != np.signbit(off[:, 1:])
    away = np.where(crossing, np.abs(0.5 * (tilt[1:] + tilt[:-1])), np.inf)
    at, reached, rows = np.argmin(away, axis=1), crossing.any(axis=1), np.arange(len(off))
    before, after = off[rows, at], off[rows, at + 1]
    between = np.clip(before / np.where(before == after, 1.0, before - after), 0.0, 1.0)
    found = np.where(reached, tilt[at] + STEP * between, tilt[np.argmin(np.abs(off), axis=1)])
    return carried(foot, task, found, float(reached.mean()))


def _moment(
    task: FootTask, centre: Float[np.ndarray, "*s 2"], pitch: Float[np.ndarray, "*s"], point: Float[np.ndarray, "*#s k"]
) -> Float[np.ndarray, "*s"]:
    """The load acts at the centre, and the recorded force along the floor as well."""
    along, up = (each.reshape(-1, *[1] * (pitch.ndim - 1)) for each in (task.forward, task.load))
    x, y = centre[..., 0] - point[..., 0], centre[..., 1] - point[..., 1]
    fx = np.cos(pitch) * along + np.sin(pitch) * up
    fy = -np.sin(pitch) * along + np.cos(pitch) * up
    return np.asarray(x * fy - y * fx)
