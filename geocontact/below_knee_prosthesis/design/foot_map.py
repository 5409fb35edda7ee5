"""What a foot does at a pitch and under a load: height, centre of pressure and bend of its keel, tabulated once.

Quasi-static, elastic and upright in the frontal plane: then a foot is a function of its pitch, its load and the force
along the ground, and a stance is a path on that table. Solving the keel along one stance for a load costs as much as
the whole table, from which every kinematic draw is read for next to nothing. Between the rows it is linear.

The force along the ground bends the keel as well, for it acts below its joints: a fifth of the load in push-off adds a
quarter to what a keel stores. Each sphere has its share of it, as it has of the load. Its effect is tabulated for a
fifth of the load forwards, and taken as linear in the force.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.interpolate import RegularGridInterpolator
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.design.terrain import LEVEL, Terrain
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.loads.centre_of_pressure import GROUND_POINT, centre_of_pressure

PITCHES, LOADS, DEPTHS = np.radians(2.0), 21, 16
"""Step of pitch [rad], rows of load, and depths that each pitch is pressed to."""
SHALLOW, DEEPER, DEEPEST, ROUNDS, PROBES = 12e-3, 1.4, 0.12, 14, 5
"""m; first depth that is tried, factor to the next, most of all, how often, and steps from the air to it."""
NEAR, LOWERED = 1e-6, 100
"""m; to which the height of touching is found, and how often the foot is lowered at most."""
DRAG, SLIPS = 0.2, 0.4
"""Force along the ground over the load: that of the second table, and the most that is read."""
FURTHER = 1.1
"""Of the depths: those of the second table, whose keel gives more under a load."""
SLIDING = 1.0
"""m/s; at which the second table's feet slide, so that friction is what is wanted on every sphere."""
MARGIN = 1.05
"""Of the loads of a stance, over them."""
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

        `forward` is the force along the ground [N]: none unless given.
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
