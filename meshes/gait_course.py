"""An invented stance: angles with which the foot, in equilibrium, would carry a usual ground reaction.

Vertical and fore-aft forces of both legs are given as functions of the share of their stance; the body's mass centre
moves by them. The leg then reaches from the hip to a foot that rolls on the floor without slipping, pressed as deep as
its load presses the keel without inertia. What really acts in a stance along these angles is for the simulation to say.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import BPoly, PchipInterpolator, RegularGridInterpolator, make_interp_spline
from scipy.optimize import fsolve
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, LegMotion, recorded_tree
from geocontact.below_knee_prosthesis.simulate import Push
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.identify.signals.filters import zero_lag
from meshes.gait_persons import SPEED, TOE_OUT

if TYPE_CHECKING:
    from casadi import Function

RATE = 200.0
"""Hz; of the course."""
BEFORE, AFTER = 0.15, 0.15
"""s; of swing on both sides of the stance."""
VERTICAL = ((0.0, 0.0), (0.06, 0.42), (0.22, 1.06), (0.48, 0.80), (0.75, 1.04), (0.93, 0.35), (1.0, 0.0))
"""Share of the stance and load over body weight; invented, as all that follows."""
FORWARD = 0.15
"""Most of the braking and pushing force over body weight."""
PELVIS = ((0.06, 4.0), (0.05, 2.5), (0.14, 0.02))
"""Amplitude of rotation and obliquity, mean and amplitude of tilt: rad, with phase in rad."""
SWAY = 0.015
"""m; of the pelvis to the side."""
SWING = {"before": (3.0, 0.0, 0.0, 24.0), "after": (4.0, 0.0, 0.0, 24.0)}
"""deg; what hip and knee change by in swing, to its start and to its end."""
LOWEST, LOWER, DEEPEST, UNDER = 0.12, 0.005, 0.09, 0.13
"""m; most that the pelvis is lowered so that the leg reaches the floor, in which steps; deepest that the foot is
pressed; from the keel's end forward to below the hip at mid-stance."""
STRAIGHTEST = np.radians(3.0)
"""rad; of the knee in stance."""
CUTOFF = 10.0
"""Hz; of the angles."""


@dataclass(frozen=True, eq=False)
class GaitCourse:
    """What drives a synthetic stance.

    Parameters
    ----------
    motion
        Of the true leg; the pelvis' free places are those that the given forces make.
    push
        Of the other leg.
    span
        From before touch-down to after toe-off [s]; touch-down is meant to be at 0.
    stance
        How long it is meant to last [s].
    """

    motion: LegMotion
    push: Push
    span: tuple[float, float]
    stance: float


def course(leg: Leg, foot: VariableStiffnessFoot, fulcrum: float, stance: float, phase: float = 0.0) -> GaitCourse:
    """Of one person on one setting.

    Parameters
    ----------
    stance
        How long it lasts [s].
    phase
        Of the pelvis' turns [rad], by which trials of a person differ.
    """
    count = round((stance + BEFORE + AFTER) * RATE)
    time = -BEFORE + np.arange(count + 1) / RATE
    weight = leg.person.mass * GRAVITY
    own, other = (weight * each for each in reactions(time, stance))
    reach = _Reach(leg, _heights(foot, fulcrum, weight))
    pelvis = _pelvis(reach, time, stance, (own + other) / leg.person.mass, phase)
    on = (time >= 0.0) & (time <= stance)
    for lower in np.arange(0.0, LOWEST, LOWER):
        down = pelvis - lower * np.eye(6)[4]
        legs = reach.angles(down[on], own[on, 1])
        if legs is not None and legs[:, 3].min() >= STRAIGHTEST:
            break
    else:
        raise ArithmeticError("the leg does not reach the floor along this course")
    angles = zero_lag(_with_swing(time, time[on], legs), 1.0 / RATE, CUTOFF)
    motion = LegMotion(leg, time, np.hstack([down, angles]))
    return GaitCourse(motion, Push(time, other), (float(time[5]), float(time[-6])), stance)


class _Reach:
    """A leg from the hip to a foot that rolls on the floor, pressed as deep as its load wants."""

    def __init__(self, leg: Leg, heights: RegularGridInterpolator) -> None:
        self.leg, self.heights = leg, heights
        self.keel = _keel_pose(leg)
        pitches = heights.grid[0]
        unloaded = heights(np.column_stack([pitches, 0.0 * pitches]))
        self.rolled = np.interp(0.0, pitches, cumulative_trapezoid(unloaded, pitches, initial=0))
        self.rolling = pitches, cumulative_trapezoid(unloaded, pitches, initial=0) - self.rolled

    @property
    def standing(self) -> float:
        """Height of the pelvis over a straight leg [m]."""
        level = float(self.heights([[0.0, 0.0]])[0])
        return float(level - self.leg.keel[1] + self.leg.thigh - self.leg.hip[1])

    def angles(
        self, pelvis: Float[np.ndarray, "t 6"], load: Float[np.ndarray, " t"]
    ) -> Float[np.ndarray, "t 4"] | None:
        """Hip and knee in each frame [rad]; None where the leg is too short."""
        found, guess = [], np.array([0.3, 0.0, 0.0, 0.15])
        for place, force in zip(pelvis, load, strict=True):
            guess, _, code, _ = fsolve(self._off, guess, args=(place, float(force)), full_output=True, xtol=1e-9)
            if code != 1:
                return None
            found.append(guess)
        return np.array(found)

    def _off(
        self, angles: Float[np.ndarray, " 4"], pelvis: Float[np.ndarray, " 6"], load: float
    ) -> Float[np.ndarray, " 4"]:
        forward, place = np.array(self.keel(np.concatenate([pelvis, angles]))).reshape(2, 3)
        pitch = np.arctan2(forward[1], np.hypot(forward[0], forward[2]))
        heading = np.arctan2(forward[2], forward[0])
        height = self.heights([[np.clip(pitch, *self.heights.grid[0][[0, -1]]), load]])[0]
        x = -np.interp(pitch, *self.rolling) - UNDER
        return np.array([place[0] - x, place[1] - height, place[2] - self.leg.hip[2], heading - TOE_OUT])


def _keel_pose(leg: Leg) -> Function:
    """Coordinates to the direction of the keel's x axis and the place of its origin, six numbers."""
    from casadi import Function, mtimes, vertcat

    tree = tree_of(recorded_tree(leg))
    forward = mtimes(tree.bodies["shank"].rotation, constant(leg.turn.apply([1.0, 0.0, 0.0])))
    return Function("keel", [tree.q], [vertcat(forward, tree.point("shank", constant(leg.keel)))])


def reactions(
    time: Float[np.ndarray, " t"], stance: float
) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
    """Of the prosthetic and the other leg over body weight, such that both carry the body on average."""
    vertical, step = PchipInterpolator(*np.transpose(VERTICAL)), footfall(stance)

    def one(start: float) -> Float[np.ndarray, "t 3"]:
        share = (time - start) / stance
        on = (share >= 0.0) & (share <= 1.0)
        up = np.where(on, vertical(np.clip(share, 0.0, 1.0)), 0.0)
        along = np.where(on, -FORWARD * np.sin(2.0 * np.pi * share), 0.0)
        return np.column_stack([along, up, 0.0 * up])

    return one(0.0), one(-step) + one(step)


def footfall(stance: float) -> float:
    """Time from one foot's touch-down to the other's [s], at which both carry the body on average."""
    return stance * float(PchipInterpolator(*np.transpose(VERTICAL)).integrate(0.0, 1.0))


def _pelvis(
    reach: _Reach, time: Float[np.ndarray, " t"], stance: float, driving: Float[np.ndarray, "t 3"], phase: float
) -> Float[np.ndarray, "t 6"]:
    """Turns by sines, place by the forces per mass; over the middle of the stance the hip is over the foot."""
    turn = 2.0 * np.pi * (time - 0.5 * stance) / (2.0 * stance)
    (a, fa), (b, fb), (mean, c) = PELVIS
    turns = [a * np.sin(turn + fa + phase), b * np.sin(turn + fb - phase), mean + c * np.sin(2.0 * turn + phase)]
    rate = cumulative_trapezoid(driving[:, :2] - np.array([0.0, GRAVITY]), time, axis=0, initial=0)
    on = (time >= 0.0) & (time <= stance)
    rate = rate - rate[on].mean(axis=0) + np.array([SPEED, 0.0])
    place = cumulative_trapezoid(rate, time, axis=0, initial=0)
    middle = int(np.argmin(np.abs(time - 0.5 * stance)))
    place[:, 0] -= place[middle, 0] + reach.leg.hip[0]
    place[:, 1] += reach.standing - place[on, 1].max()
    return np.column_stack([*turns, place, SWAY * np.sin(turn)])


def _heights(foot: VariableStiffnessFoot, fulcrum: float, weight: float) -> RegularGridInterpolator:
    """Height of the keel's origin over pitch [rad] and load [N], without rates."""
    still = foot.at(fulcrum)
    centre, radius = foot.sole.spheres.centre, foot.sole.spheres.radius
    pitches, loads = np.radians(np.arange(-60.0, 41.0, 4.0)), np.linspace(0.0, 1.4 * weight, 15)
    rows = []
    for pitch in pitches:
        turn = Rotation.from_euler("z", pitch)
        lowest = float((turn.apply(centre)[:, 1] - radius).min())
        deep = DEEPEST
        while True:
            down = np.linspace(0.0, deep, 40)
            places = np.column_stack([0.0 * down, -lowest - down, 0.0 * down])
            poses = RigidTransform.from_components(places, Rotation.concatenate([turn] * len(down)))
            try:
                force = np.maximum.accumulate(still.solve(poses, HalfSpace()).force[:, 1])
                break
            except ArithmeticError:
                deep *= 0.8
        rows.append(-lowest - np.interp(loads, force, down))
    return RegularGridInterpolator((pitches, loads), np.array(rows))


def _with_swing(
    time: Float[np.ndarray, " t"], inside: Float[np.ndarray, " s"], angles: Float[np.ndarray, "s 4"]
) -> Float[np.ndarray, "t 4"]:
    """Angles of the stance, and what hip and knee do before and after it."""
    smooth = make_interp_spline(inside, zero_lag(angles, float(inside[1] - inside[0]), CUTOFF), k=5)
    found = smooth(np.clip(time, inside[0], inside[-1]))
    ends = {"before": (inside[0], time[0] - 0.02), "after": (inside[-1], time[-1] + 0.02)}
    for name, (end, far) in ends.items():
        beyond = time < end if name == "before" else time > end
        at = [smooth(end), smooth(end, 1), smooth(end, 2)]
        swung = [at[0] + np.radians(SWING[name]), 0.0 * at[0], 0.0 * at[0]]
        pair = (swung, at) if far < end else (at, swung)
        found[beyond] = BPoly.from_derivatives(sorted((far, end)), pair)(time[beyond])
    return np.asarray(found)
