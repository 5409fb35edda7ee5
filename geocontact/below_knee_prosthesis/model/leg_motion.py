"""A recorded motion of pelvis and leg as what drives a stance: the bushing's frame, and what accelerates all above it.

Pelvis, thigh and residual limb turn as they were recorded, so that against the pelvis nothing above the socket is
free: they move along with its free place like one point mass, pushed besides by the inertia of their recorded motion
against it. That is exact, and leaves a much smaller tree to the equations (`stance_model`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline

from geocontact.below_knee_prosthesis.model.leg import Leg
from geocontact.below_knee_prosthesis.model.leg_tree import PELVIS, RECORDED, recorded_tree
from geocontact.dynamics.recorded_inputs import SMOOTH, RecordedInputs, recorded_inputs

TURNS: Final = "XYZ"
"""Of the bushing's frame in the ground, as `joint_kinds.free` turns."""


@dataclass(frozen=True, eq=False)
class LegMotion:
    """Recorded coordinates of one leg, filtered, without gaps.

    Parameters
    ----------
    leg
        Whose motion it is.
    time
        [s], even steps.
    values
        Of `RECORDED` [rad, m]; x forward along the walk, y up from the floor.
    """

    leg: Leg
    time: Float[np.ndarray, " t"]
    values: Float[np.ndarray, "t 10"]

    def of(self, name: str) -> Float[np.ndarray, " t"]:
        """One coordinate."""
        return self.values[:, RECORDED.index(name)]

    def at(self, time: Float[np.ndarray, " f"]) -> Float[np.ndarray, "f 10"]:
        """All coordinates at other times [s], on splines of the degree that a simulation is driven with."""
        return np.asarray(make_interp_spline(self.time, self.values, k=SMOOTH)(time))

    def part(self, start: float, stop: float) -> LegMotion:
        """Frames between two times, one more on each side where there is one."""
        step = self.time[1] - self.time[0]
        kept = (self.time > start - step) & (self.time < stop + step)
        return LegMotion(self.leg, self.time[kept], self.values[kept])

    def place(self, axis: str, when: float) -> tuple[float, float]:
        """Place [m] and speed [m/s] of the pelvis along x, y or z at a time."""
        curve = make_interp_spline(self.time, self.of(PELVIS[3 + "xyz".index(axis)]), k=SMOOTH)
        return float(curve(when)), float(curve(when, 1))


def driving_inputs(motion: LegMotion, pushing: Float[np.ndarray, "t 3"]) -> RecordedInputs:
    """Inputs of the equations of a stance: the bushing's frame with its derivatives, forces on the pelvis.

    Parameters
    ----------
    pushing
        Of the other leg on the pelvis at the motion's times, in the ground's frame [N].

    The frame's turns are those in the ground, its shifts those from the pelvis' free place (x, y), and z in the ground.
    """
    tree = recorded_tree(motion.leg)
    poses = tree.poses(motion.values)
    frame = poses["shank"] * motion.leg.X_SB
    pelvis = poses["pelvis"].translation.copy()
    pelvis[:, 2] = 0.0
    turns = np.unwrap(frame.rotation.as_euler(TURNS), axis=0)
    bearing = recorded_inputs(motion.time, np.hstack([turns, frame.translation - pelvis]), derivatives=2)
    moment = np.zeros_like(pelvis)
    for name, (mass, centre, _) in (("thigh", motion.leg.thigh_body()), ("shank", motion.leg.residual_body())):
        moment += mass * (poses[name].apply(centre) - pelvis)
    inertia = make_interp_spline(motion.time, moment, k=SMOOTH)(motion.time, 2)
    return bearing.beside(recorded_inputs(motion.time, (pushing - inertia)[:, :2]))


def carried_mass(leg: Leg, keel: float) -> float:
    """Of all above the socket [kg]; `keel` is the keel's own mass."""
    return leg.pelvis_mass(keel) + leg.thigh_body()[0] + leg.residual_body()[0]
