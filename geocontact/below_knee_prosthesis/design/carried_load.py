"""A foot that carries the loads of a stance, with the person's angles kept or with the ankle's torque kept.

People neither keep their angles on another foot nor their torques; what they do is taken to lie between. With the
angles kept the socket turns as recorded and the leg, free upwards, finds the height at which the load is carried. With
the torque kept the foot turns until the load acts about the ankle with the moment that it had on the recorded foot.
Both are quasi-static: the recorded load is kept, which with a pelvis that is free upwards is nearly so. Torques kept in
hip and knee are `joint_torques_kept`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.foot_map import PLACES, FootMap
from geocontact.below_knee_prosthesis.design.foot_task import FootTask

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

    def moment(self, point: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " t"]:
        """Of the ground's force about a point of the keel's frame in its sagittal plane [N m]; positive: toes up."""
        return _moment(self.task, self.centre, self.task.pitch + self.tilt, point)

    @property
    def ankle_moment(self) -> Float[np.ndarray, " t"]:
        """About the ankle [N m]."""
        return self.moment(self.task.ankle)


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
    task: FootTask, centre: Float[np.ndarray, "*s 2"], pitch: Float[np.ndarray, "*s"], point: Float[np.ndarray, " 3"]
) -> Float[np.ndarray, "*s"]:
    """The load acts at the centre, and the recorded force along the floor as well."""
    along, up = (each.reshape(-1, *[1] * (pitch.ndim - 1)) for each in (task.forward, task.load))
    x, y = centre[..., 0] - point[0], centre[..., 1] - point[1]
    fx = np.cos(pitch) * along + np.sin(pitch) * up
    fy = -np.sin(pitch) * along + np.cos(pitch) * up
    return np.asarray(x * fy - y * fx)
