"""How the intact leg of a synthetic person walks beside a prosthetic stance: a foot that rolls from heel to toes.

Footholds are a step before and behind that of the prosthesis. In stance the foot turns about its heel, lies flat, and
turns about its toe joint while the toes stay on the floor; in swing it is carried on a smooth curve. Hip, knee and
ankle follow. All sizes are invented.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.identify.signals.filters import zero_lag
from meshes.gait_course import UNDER, footfall
from meshes.gait_persons import SPEED, TOE_OUT

STRIKE, FLAT, RISE, OFF = np.radians(14.0), 0.12, 0.55, np.radians(-50.0)
"""Pitch at heel strike; shares of the stance at which the foot lies flat and its heel rises; pitch at toe-off."""
CLEAR, DANGLE = 0.17, np.radians(-25.0)
"""Height of the ankle [m] and pitch of the foot in the middle of the swing."""
STRETCHED = 0.9985
"""Of the leg's length that the ankle may be away from the hip."""
CUTOFF = 10.0
"""Hz; of the angles."""
ROLLED = 0.05, 0.80
"""Shares of the foot between which the centre of pressure moves forward."""
ANGLES = (
    "hip_flexion_l",
    "hip_adduction_l",
    "hip_rotation_l",
    "knee_flexion_l",
    "ankle_flexion_l",
    "ankle_inversion_l",
    "ankle_rotation_l",
    "toe_extension_l",
)


@dataclass(frozen=True, eq=False)
class IntactWalk:
    """Angles of the intact leg [rad], and where the floor presses on its foot [m]."""

    time: Float[np.ndarray, " t"]
    angles: Float[np.ndarray, "t 8"]
    centre: Float[np.ndarray, "t 3"]


def intact_walk(
    leg: IntactLeg,
    pelvis: RigidTransform,
    time: Float[np.ndarray, " t"],
    stance: float,
    sunk: Float[np.ndarray, " t"] | None = None,
) -> IntactWalk:
    """Of a leg on a pelvis that moves so, beside a prosthetic stance of that length [s] that begins at 0.

    `sunk` is how deep the foot is in the floor [m].
    """
    step = footfall(stance)
    holds = {start: SPEED * start for start in (-3.0 * step, -step, step)}
    known = [_standing(leg, start, stance, x) for start, x in holds.items()]
    course = np.concatenate([part for pair in zip(known, _swings(known), strict=False) for part in pair] + [known[-1]])
    order = np.argsort(course[:, 0])
    curve = make_interp_spline(*_unique(course[order]), k=3)
    place = curve(time)
    turn = Rotation.from_euler("y", TOE_OUT) * Rotation.from_euler("z", place[:, 2:3])
    if sunk is not None:
        place[:, 1] -= sunk
    angles = _reached(leg, pelvis, np.column_stack([place[:, :2], np.full(len(time), leg.hip[2])]), turn)
    smooth = zero_lag(np.column_stack([angles, place[:, 3]]), float(time[1] - time[0]), CUTOFF)
    centre = np.zeros((len(time), 3))
    for start, x in holds.items():
        share = (time - start) / stance
        on = (share > -0.5) & (share < 1.5)
        along = leg.heel[0] + leg.length * np.interp(share[on], (0.0, 1.0), ROLLED)
        flat = Rotation.from_euler("y", TOE_OUT).apply(np.column_stack([along, 0.0 * along, 0.0 * along]))
        centre[on] = flat + np.array([_ankle(leg, x), 0.0, leg.hip[2]])
    return IntactWalk(time, smooth, centre)


def _ankle(leg: IntactLeg, x: float) -> float:
    """Where the ankle is over a foothold, the heel of which is as far back as that of the prosthesis."""
    return x - UNDER - float(leg.heel[0])


def _standing(leg: IntactLeg, start: float, stance: float, x: float) -> Float[np.ndarray, "k 5"]:
    """Time, forward and upward place of the ankle, pitch and toes of one stance."""
    share = np.linspace(0.0, 1.0, 41)
    pitch = np.interp(share, (0.0, FLAT), (1.0, 0.0)) ** 2 * STRIKE
    rise = np.clip((share - RISE) / (1.0 - RISE), 0.0, 1.0)
    pitch = pitch + OFF * rise**2
    heel, ball = np.array([leg.heel[0] + 0.01, -leg.sole]), np.array([leg.toe_joint[0], -leg.sole])
    about = np.where((rise > 0.0)[:, None], ball, heel)
    c, s = np.cos(pitch), np.sin(pitch)
    moved = np.column_stack([c * about[:, 0] - s * about[:, 1], s * about[:, 0] + c * about[:, 1]])
    ankle = np.array([_ankle(leg, x), leg.sole]) + about - moved
    return np.column_stack([start + share * stance, ankle, pitch, np.maximum(-pitch, 0.0)])


def _swings(known: list[Float[np.ndarray, "k 5"]]) -> list[Float[np.ndarray, "1 5"]]:
    """One point between two stances each."""
    found = []
    for before, after in pairwise(known):
        middle = 0.5 * (before[-1] + after[0])
        found.append(np.array([[middle[0], middle[1], CLEAR, DANGLE, 0.1]]))
    return found


def _unique(rows: Float[np.ndarray, "k 5"]) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, "k 4"]]:
    kept = np.concatenate([[True], np.diff(rows[:, 0]) > 1e-6])
    return rows[kept, 0], rows[kept, 1:]


def _reached(
    leg: IntactLeg, pelvis: RigidTransform, ankle: Float[np.ndarray, "t 3"], foot: Rotation
) -> Float[np.ndarray, "t 7"]:
    """Hip, knee and ankle of a left leg whose hip does not turn about the thigh; as near as the leg reaches."""
    away = pelvis.inv().apply(ankle) - leg.hip
    long = np.linalg.norm(away, axis=1)
    first, second = leg.thigh, leg.shank
    reach = np.minimum(long, STRETCHED * (first + second))
    away = away * (reach / long)[:, None]
    knee = np.arccos(np.clip((reach**2 - first**2 - second**2) / (2.0 * first * second), -1.0, 1.0))
    chain = np.column_stack([-second * np.sin(knee), -first - second * np.cos(knee)])
    adduction = np.arcsin(np.clip(-away[:, 2] / chain[:, 1], -1.0, 1.0))
    flat = np.column_stack([chain[:, 0], chain[:, 1] * np.cos(adduction)])
    flexion = np.arctan2(away[:, 1], away[:, 0]) - np.arctan2(flat[:, 1], flat[:, 0])
    flexion = np.arctan2(np.sin(flexion), np.cos(flexion))
    thigh = Rotation.from_euler("ZX", np.column_stack([flexion, -adduction]))
    shank = pelvis.rotation * thigh * Rotation.from_euler("z", -knee[:, None])
    turned = (shank.inv() * foot).as_euler("ZXY") * np.array([1.0, -1.0, -1.0])
    return np.column_stack([flexion, adduction, 0.0 * knee, knee, turned])
