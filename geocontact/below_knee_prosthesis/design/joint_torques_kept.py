"""The person's joint torques kept: those that the present foot needs act on, and the leg moves as another foot lets it.

Planar forward dynamics (`sagittal_leg`) of thigh and shank under the rest of the body on a foot that bears what its map
says at a pitch and a height. Torques at hip and knee, and all that acts on the body besides the leg, are what the
recorded motion needs on the present foot; on it the motion is therefore the recorded one, exactly. What deviates is
integrated. A leg under load is a strut: torques that are given over time do not hold it, and on another foot it folds
within a part of the stance (`held`). So a weak spring and damper at hip and knee towards the recorded angles go with
them, as comparisons by forward dynamics use tracking. Their stiffness, that of a knee in stance (Shamaei, Sawicki &
Dollar 2013, Estimation of quasi-stiffness of the human knee in the stance phase of walking, PLoS ONE 8, e59993), and
all other numbers here are invented.

Along the ground the sole sticks by a spring and a damper up to its friction. Residual limb and socket are one body:
the forces between them are whatever that needs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline

from geocontact.below_knee_prosthesis.design.foot_map import PLACES, FeetOnGround, FootMap
from geocontact.below_knee_prosthesis.design.foot_task import (
    FootTask,
    SagittalLeg,
    bias,
    force_along,
    mass_matrix,
    point_of_shank,
    thigh_direction,
    turned,
)

STIFFNESS, RETARDATION = 2.0, 0.05
"""Tracking at hip and knee, of the body's mass [N m/(rad kg)], and damping over stiffness [s]; invented."""
STICK, STICK_DAMPING, SOLE_DAMPING = 1e5, 500.0, 1500.0
"""N/m, N s/m; of a sole that sticks, and of one that is pressed otherwise than on the present foot; invented."""
GRIP = 0.8
"""Friction of the sole; invented."""
STEP = 4e-3
"""s; of the integration."""
FOLDED = np.radians(10.0)
"""rad; a hip or knee that is further from where it was recorded no longer walks."""


@dataclass(frozen=True, eq=False)
class RecordedLeg:
    """The motion on the present foot at twice as many times as there are steps.

    Parameters
    ----------
    q, u, a
        Of the leg's coordinates [m, rad], and their derivatives; accelerations are those of `FootTask`, for those of
        a spline over the loaded stance alone are wild at its ends.
    driven
        What drives the coordinates besides weight and the ground: all that acts on the body, torques [N, N m].
    speed
        Of the place on the foot where the centre of pressure is, forward and upwards [m/s].
    raised
        Height of the keel by the map over that by the coordinates [m].
    """

    time: Float[np.ndarray, " t"]
    q: Float[np.ndarray, "t 4"]
    u: Float[np.ndarray, "t 4"]
    a: Float[np.ndarray, "t 4"]
    driven: Float[np.ndarray, "t 4"]
    speed: Float[np.ndarray, "t 2"]
    raised: Float[np.ndarray, " t"]


@dataclass(frozen=True, eq=False)
class MovedLeg:
    """What became of each foot, at the steps.

    Parameters
    ----------
    off
        Of the coordinates from the recorded ones [m, rad].
    load, forward
        Of the ground, across it and along it [N].
    tracking
        Torques of spring and damper at hip and knee [N m].
    """

    time: Float[np.ndarray, " t"]
    off: Float[np.ndarray, "t n 4"]
    tracking: Float[np.ndarray, "t n 2"]
    load: Float[np.ndarray, "t n"]
    forward: Float[np.ndarray, "t n"]

    @property
    def joints(self) -> Float[np.ndarray, "t n 2"]:
        """Hip and knee from where they were recorded [rad]; the pelvis turns as it did."""
        return np.stack([self.off[..., 2], self.off[..., 3] - self.off[..., 2]], axis=-1)

    @property
    def held(self) -> Float[np.ndarray, " n"]:
        """How long no joint is further off than `FOLDED` [s]."""
        folded = (np.abs(self.joints) > FOLDED).any(axis=-1) | ~np.isfinite(self.off).all(axis=-1)
        first = np.where(folded.any(axis=0), folded.argmax(axis=0), len(self.time) - 1)
        return np.asarray(self.time[first] - self.time[0])


def recorded_motion(foot: FootMap, task: FootTask) -> RecordedLeg:
    """Motion of the leg on the present foot, which bears the recorded load and rolls without slipping."""
    leg, count = task.leg, int(np.ceil((task.time[-1] - task.time[0]) / STEP))
    time = np.linspace(task.time[0], task.time[-1], 2 * count + 1)
    turns = make_interp_spline(task.time, np.column_stack([task.thigh, task.pitch]), k=5)
    (thigh, pitch), (_, rate) = turns(time).T, turns(time, 1).T
    load, forward = np.maximum(curve(time, task.time, task.load), 0.0), curve(time, task.time, task.forward)
    channels = foot.at(pitch, load)
    arm = turned(pitch, channels[:, 1:PLACES])
    rolled = rate * arm[:, 1]
    along = np.concatenate([[0.0], np.cumsum(0.5 * (rolled[1:] + rolled[:-1]) * np.diff(time))])
    keel = np.column_stack([along, channels[:, 0]])
    hip = keel + turned(pitch, np.broadcast_to(leg.knee, keel.shape)) + leg.length * thigh_direction(thigh)
    course = make_interp_spline(task.time, _at(task.time, time, hip), k=5)
    q, u = (np.hstack([course(time, k), turns(time, k)]) for k in range(2))
    a = np.asarray(make_interp_spline(task.time, task.acceleration, k=3)(time))
    _, speed = point_of_shank(leg, q, u, channels[:, 1:PLACES])
    origin, _ = point_of_shank(leg, q, u, np.zeros(2))
    force = force_along(leg, q, channels[:, 1:PLACES], np.column_stack([forward, load]))
    driven = np.einsum("tij,tj->ti", mass_matrix(leg, q), a) + bias(leg, q, u) - force
    return RecordedLeg(time, q, u, a, driven, speed, channels[:, 0] - origin[:, 1])


@dataclass(frozen=True, eq=False)
class OtherFeet:
    """Feet that the leg may stand on, all at once.

    Parameters
    ----------
    feet, leg
        With the ground as their maps have it, and the leg in each keel's frame.
    turn
        Of each foot against the present one, toes up [rad].
    slope
        By which the ground rises forwards [rad].
    start
        Load across the ground with which the stance begins [N].
    forward
        Along the ground, as recorded [N], at the times of `recorded`.
    tracking
        Factor on `STIFFNESS`; with 0 torques alone are kept.
    """

    recorded: RecordedLeg
    feet: FeetOnGround
    leg: SagittalLeg
    turn: Float[np.ndarray, " n"]
    slope: float
    start: float
    forward: Float[np.ndarray, " t"]
    tracking: float

    def moved(self) -> MovedLeg:
        """From the recorded state on ground that is as high as the first load needs, by Runge and Kutta's rule."""
        r, n = self.recorded, len(self.turn)
        count, h = len(r.time) // 2 + 1, r.time[2] - r.time[0]
        state, found = np.zeros((n, 9)), np.zeros((count, n, 4))
        load, forward, tracking = np.zeros((count, n)), np.zeros((count, n)), np.zeros((count, n, 2))
        floor = self._floor()
        for k in range(count):
            found[k] = state[:, :4]
            along = self._tracking(state[:, :4], state[:, 4:8])
            tracking[k] = np.column_stack([along[:, 2] + along[:, 3], along[:, 3]])
            first, load[k], forward[k] = self._rate(2 * k, state, floor)
            if k == count - 1:
                break
            second = self._rate(2 * k + 1, state + 0.5 * h * first, floor)[0]
            third = self._rate(2 * k + 1, state + 0.5 * h * second, floor)[0]
            fourth = self._rate(2 * k + 2, state + h * third, floor)[0]
            state = state + h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
        return MovedLeg(r.time[::2], found, tracking, load, forward)

    @property
    def mass(self) -> float:
        """Mass of the whole body [kg]."""
        return self.leg.body + self.leg.thigh[0] + self.leg.shank[0]

    def _rate(
        self, k: int, state: Float[np.ndarray, "n 9"], floor: Float[np.ndarray, " n"]
    ) -> tuple[Float[np.ndarray, "n 9"], Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
        """Rate of deviations, their rates and the slip; with the load and the force along the ground."""
        r, leg, off, rate, slip = self.recorded, self.leg, state[:, :4], state[:, 4:8], state[:, 8]
        q, u = r.q[k] + off, r.u[k] + rate
        q[:, 3] += self.turn
        along, up = (
            np.array([np.cos(self.slope), np.sin(self.slope)]),
            np.array([-np.sin(self.slope), np.cos(self.slope)]),
        )
        origin, _ = point_of_shank(leg, q, u, np.zeros_like(leg.knee))
        height = origin @ up + r.raised[k] * up[1] - floor
        load, centre = self.feet.borne(q[:, 3] - self.slope, height)
        _, speed = point_of_shank(leg, q, u, centre)
        speed = speed - r.speed[k]
        on = load > 0.0
        load = np.where(on, np.maximum(load - SOLE_DAMPING * (speed @ up), 0.0), 0.0)
        sliding = np.where(on, speed @ along, 0.0)
        wanted = self.forward[k] - STICK * slip - STICK_DAMPING * sliding
        held = np.clip(wanted, -GRIP * load, GRIP * load)
        sticking = (held == wanted) | (sliding * slip < 0.0)
        force = held[:, None] * along + load[:, None] * up
        driving = r.driven[k] + force_along(leg, q, centre, force) + self._tracking(off, rate) - bias(leg, q, u)
        found = np.linalg.solve(mass_matrix(leg, q), driving[..., None])[..., 0] - r.a[k]
        return np.column_stack([rate, found, np.where(sticking, sliding, 0.0)]), load, held

    def _tracking(self, off: Float[np.ndarray, "n 4"], rate: Float[np.ndarray, "n 4"]) -> Float[np.ndarray, "n 4"]:
        """Torques of spring and damper at hip and knee, along the coordinates [N m]."""
        size = self.tracking * STIFFNESS * self.mass
        hip, knee = (-size * (of + RETARDATION * by) for of, by in zip(_joints(off), _joints(rate), strict=True))
        return np.column_stack([np.zeros((len(off), 2)), hip - knee, knee])

    def _floor(self) -> Float[np.ndarray, " n"]:
        """Height of each ground, across it, with which the foot bears its first load as the stance begins [m]."""
        r, n = self.recorded, len(self.turn)
        q = np.tile(r.q[0], (n, 1))
        q[:, 3] += self.turn
        origin, _ = point_of_shank(self.leg, q, 0.0 * q, np.zeros_like(self.leg.knee))
        up = np.array([-np.sin(self.slope), np.cos(self.slope)])
        placed: Float[np.ndarray, " n"] = origin @ up + r.raised[0] * up[1]
        return np.asarray(placed - self.feet.height(q[:, 3] - self.slope, np.full(n, self.start)))


def curve(
    wanted: Float[np.ndarray, " s"], time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"]
) -> Float[np.ndarray, " s"]:
    """A force at other times, by a cubic spline."""
    return np.asarray(make_interp_spline(time, values, k=3)(wanted))


def _joints(of: Float[np.ndarray, "n 4"]) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """Hip and knee of the coordinates' deviations."""
    return of[..., 2], of[..., 3] - of[..., 2]


def _at(
    time: Float[np.ndarray, " s"], dense: Float[np.ndarray, " t"], of: Float[np.ndarray, "t c"]
) -> Float[np.ndarray, "s c"]:
    """Columns at some of the times, linear between."""
    return np.column_stack([np.interp(time, dense, column) for column in of.T])


def stacked(legs: Sequence[SagittalLeg]) -> SagittalLeg:
    """The same leg in several keels' frames as one."""
    return replace(
        legs[0], knee=np.stack([each.knee for each in legs]), centre=np.stack([each.centre for each in legs])
    )
