"""A synthetic stance of the variable-stiffness foot: invented pitch and vertical load of a man of 84 kg, 0.7 s, 200 Hz.

Heights are such that the keel without rates carries that load; the foot moves forward so that what touches slides no
faster than friction needs for a braking and a pushing force. Everything is invented but the mass, the mean of the
study's four participants.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PchipInterpolator, make_interp_spline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.resultant import pose_rate

MASS, GRAVITY, LASTING, RATE = 84.0, 9.80665, 0.7, 200.0
WEIGHT = MASS * GRAVITY
LEVEL = HalfSpace()
VERTICAL = ((-0.05, 0.0), (0.0, 0.0), (0.06, 0.45), (0.2, 1.1), (0.48, 0.8), (0.76, 1.1), (1.0, 0.0), (1.05, 0.0))
"""Share of the stance and vertical load over body weight."""
PITCH = ((-0.2, 22.0), (0.0, 18.0), (0.15, 2.0), (0.5, -4.0), (0.8, -18.0), (1.0, -36.0), (1.2, -45.0))
"""Share of the stance and pitch of the foot, toes up [deg]."""
FORWARD = 0.18
"""Most of the braking and pushing force over body weight."""
DEEPEST, HALVINGS = 0.06, 30
"""m, and of the interval in which heights are sought."""
SMOOTH = 2.0
"""Samples; standard deviation of the smoothing of height and shift."""


@dataclass(frozen=True)
class Stance:
    """Poses `X_GK` at some times [s], and their rates."""

    time: np.ndarray
    poses: RigidTransform
    rate: np.ndarray


def stance(foot: VariableStiffnessFoot, fulcrum: float) -> Stance:
    """Of the foot at that fulcrum."""
    time = np.arange(round(LASTING * RATE) + 1) / RATE
    share, still = time / LASTING, foot.at(fulcrum)
    load = WEIGHT * PchipInterpolator(*np.transpose(VERTICAL))(share)
    pitch = np.radians(PchipInterpolator(*np.transpose(PITCH))(share))
    turn = Rotation.from_euler("z", pitch[:, None])
    height = gaussian_filter1d(heights(still, turn, load), SMOOTH)
    law = foot.law
    ratio = FORWARD * WEIGHT * -np.sin(2.0 * np.pi * share) / np.maximum(load, 0.1 * WEIGHT)
    wanted, speed = -ratio * law.threshold_speed / law.kinetic[0], np.zeros(len(time))
    for _ in range(4):
        shift = cumulative_trapezoid(speed, time, initial=0.0)
        poses = RigidTransform.from_components(np.stack([shift, height, 0.0 * shift], axis=1), turn)
        moved = still.solve(poses, LEVEL, rate=pose_rate(time, poses), time=time)
        pressing = moved.loads.pressing.sum(axis=1)
        sliding = (moved.loads.pressing * moved.sliding[..., 0]).sum(axis=1)
        speed += np.where(pressing > 1.0, wanted - sliding / np.maximum(pressing, 1.0), 0.0)
        speed = gaussian_filter1d(speed, SMOOTH)
    return Stance(time, poses, pose_rate(time, poses))


def finer(one: Stance, factor: int) -> Stance:
    """The same by splines of degree 5, as simulations take it, at so many times the rate; rates are the splines'."""
    time = np.linspace(one.time[0], one.time[-1], factor * (len(one.time) - 1) + 1)
    turns = np.unwrap(one.poses.rotation.as_euler("XYZ"), axis=0)
    curve = make_interp_spline(one.time, np.hstack([turns, one.poses.translation]), k=5)

    def at(when: np.ndarray) -> RigidTransform:
        values = curve(when)
        return RigidTransform.from_components(values[:, 3:], Rotation.from_euler("XYZ", values[:, :3]))

    step = 1e-5
    ends = [at(np.clip(time + sign * step, time[0], time[-1])) for sign in (1.0, -1.0)]
    apart = np.clip(time + step, time[0], time[-1]) - np.clip(time - step, time[0], time[-1])
    rate = (ends[0].as_matrix() - ends[1].as_matrix()) / apart[:, None, None]
    return Stance(time, at(time), rate)


def heights(still: QuasiStaticKeel, turn: Rotation, load: np.ndarray) -> np.ndarray:
    """Of the keel's origin above the ground [m] where the foot carries that load, or just touches; by bisection."""
    centres = np.einsum("tij,nj->tni", turn.as_matrix(), still.sole.spheres.centre)
    lowest = (centres[..., 1] - still.sole.spheres.radius).min(axis=1)
    low, high = np.zeros(len(load)), np.full(len(load), DEEPEST)
    for _ in range(HALVINGS):
        deep = 0.5 * (low + high)
        origin = np.stack([0.0 * deep, -lowest - deep, 0.0 * deep], axis=1)
        carried = still.solve(RigidTransform.from_components(origin, turn), LEVEL).force[:, 1]
        low, high = np.where(carried < load, deep, low), np.where(carried < load, high, deep)
    return -lowest - np.where(load > 0.0, 0.5 * (low + high), 0.0)
