"""A synthetic passive trial: the feet's model itself stands up, so that what is planted can be found again.

Not a recording, and no test of the model's form: calibration and truth share their equations. Noise is white; its
sizes and the course of the angles are invented.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlledTrial, ControlProblem, Course
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
from geocontact.standing_up.chain import COORDINATES, JOINTS, Subject
from geocontact.standing_up.feet import FOOT_PARAMETERS, PLANTED, FeetOnGround

SEATED = np.radians([22.0, 70.0, 45.0])
"""Lean of shank forwards, thigh backwards and trunk forwards at seat-off [rad]."""
STANDING = np.radians([4.0, 4.0, 4.0])
SETTLED = 0.006
"""Depth of the spheres where the search starts [m]."""
COARSE = 10
"""Intervals of a first search, whose answer is where the finer one starts."""
MOST_TORQUE = 1000.0
"""Of both legs [N m]."""
N = len(COORDINATES)


@dataclass(frozen=True)
class StandingTrial:
    """What a passive trial records.

    Parameters
    ----------
    time
        From seat-off on, even [s].
    q, u
        Coordinates and rates [m, rad, m/s, rad/s].
    force, centre
        Of the ground on both feet [N], and its centre of pressure ahead of the origin [m].
    name
        As messages call it.
    """

    time: Float[np.ndarray, " t"]
    q: Float[np.ndarray, "t 6"]
    u: Float[np.ndarray, "t 6"]
    force: Float[np.ndarray, "t 2"]
    centre: Float[np.ndarray, " t"]
    name: str = "trial"

    @property
    def rate(self) -> float:
        """Samples a second."""
        return float((len(self.time) - 1) / np.ptp(self.time))


@dataclass(frozen=True)
class StandingNoise:
    """Standard deviations: of lengths [m], angles [rad], rates [m/s, rad/s], force [N] and centre [m]."""

    length: float = 5e-4
    angle: float = np.radians(0.3)
    rate: float = 0.02
    force: float = 2.0
    centre: float = 1e-3


def rising(seconds: float, seated: Float[np.ndarray, " 3"] = SEATED, p: Float[np.ndarray, " p"] = PLANTED) -> Course:
    """Coordinates by the polynomial of least jerk from seat-off to standing, the foot flat on the ground."""
    height = p[3] - SETTLED

    def course(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 6"]:
        s = np.clip(time / seconds, 0.0, 1.0)[:, None]
        shank, thigh, trunk = (seated + (STANDING - seated) * (10 * s**3 - 15 * s**4 + 6 * s**5)).T
        foot = np.tile([0.0, height, 0.0], (len(time), 1))
        return np.column_stack([foot, -shank, shank + thigh, -thigh - trunk])

    return course


def standing_up(
    feet: FeetOnGround,
    subject: Subject,
    *,
    seconds: float = 1.5,
    seated: Float[np.ndarray, " 3"] = SEATED,
    planted: Float[np.ndarray, " p"] = PLANTED,
    intervals: int = 50,
) -> tuple[ControlProblem, CollocationResult]:
    """The motion with planted parameters closest to `rising`, with little jerk and torque."""
    from casadi import SX, sumsqr

    wanted, jerk = SX.sym("wanted", N), SX.sym("jerk", N)
    e = feet.equations
    off = (e.q - wanted) / np.r_[0.01, 0.01, np.full(4, np.radians(2.0))]
    cost = sumsqr(off) + 1e-5 * sumsqr(jerk) + 1e-6 * sumsqr(e.w)
    system = jerk_controlled(
        e,
        controlled=range(3),
        control_names=JOINTS,
        data=wanted,
        jerk=jerk,
        cost=cost,
        parameter_names=[each.name for each in FOOT_PARAMETERS],
    )
    course = rising(seconds, seated, planted)
    trial = standing_trial("synthetic", seconds, feet, planted, course, course)
    problem = ControlProblem(system, (trial,), (planted, planted), planted, *problem_scales(subject))
    coarse = solve(problem, SolverOptions("legendre", 4, COARSE, 1e-7))
    return problem, solve(problem, SolverOptions("legendre", 4, intervals, 1e-7), warm=coarse)


def standing_trial(
    name: str, seconds: float, feet: FeetOnGround, p: Float[np.ndarray, " p"], guess: Course, data: Course
) -> ControlledTrial:
    """No bounds, free ends; the search starts on courses of the coordinates and the torques that they need."""
    from casadi import Function

    e = feet.equations
    needed = Function("needed", [e.q, e.u, e.a, e.w, e.p], [-e.balance[3:, :]])

    def guess_x(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 18"]:
        h = 1e-2
        before, at, after = (guess(np.clip(time + k * h, 0.0, seconds)) for k in (-1, 0, 1))
        return np.hstack([at, (after - before) / (2 * h), (after - 2 * at + before) / h**2])

    def guess_u(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 9"]:
        x, many = guess_x(time), needed.map(len(time))
        none = np.zeros((3, len(time)))
        torque = many(x[:, :N].T, x[:, N : 2 * N].T, x[:, 2 * N :].T, none, np.tile(p[:, None], (1, len(time))))
        return np.hstack([np.zeros((len(time), N)), np.clip(torque.full().T, -MOST_TORQUE, MOST_TORQUE)])

    wide, most = np.full(3 * N, np.inf), np.full(N + 3, np.inf)
    return ControlledTrial(
        name,
        0.0,
        (seconds, seconds),
        (-wide, wide),
        (-most, most),
        (-wide, wide),
        (-wide, wide),
        guess_x,
        guess_u,
        data,
    )


def problem_scales(
    subject: Subject,
) -> tuple[Float[np.ndarray, " 6"], Float[np.ndarray, " 18"], Float[np.ndarray, " 9"]]:
    """Of the balance a tenth of body weight, along and about; of the states and the controls what standing up has."""
    place = np.r_[[0.01, 0.01, 0.05], np.ones(3)]
    speed = np.r_[[0.1, 0.1, 0.5], np.ones(3)]
    change = np.r_[[1.0, 1.0, 5.0], np.full(3, 5.0)]
    jerk = np.r_[[20.0, 20.0, 100.0], np.full(3, 50.0)]
    return np.full(N, subject.mass), np.r_[place, speed, change], np.r_[jerk, np.full(3, 100.0)]


def seen_in(
    feet: FeetOnGround, motion: CollocatedMotion, p: Float[np.ndarray, " p"], time: Float[np.ndarray, " t"], name: str
) -> StandingTrial:
    """What perfect encoders and a perfect plate see of a motion at times [s]."""
    from casadi import Function

    e, x = feet.equations, motion.state(time)
    plate = Function("plate", [e.q, e.u, e.p], [feet.force, feet.centre]).map(len(time))
    force, centre = (each.full() for each in plate(x[:, :N].T, x[:, N : 2 * N].T, np.tile(p[:, None], (1, len(time)))))
    return StandingTrial(time, x[:, :N], x[:, N : 2 * N], force.T, centre[0], name)


def recorded(
    feet: FeetOnGround,
    motion: CollocatedMotion,
    p: Float[np.ndarray, " p"],
    rate: float,
    noise: StandingNoise,
    seed: int,
    name: str = "trial",
) -> StandingTrial:
    """What encoders and a plate record of a motion, `rate` samples a second."""
    rng = np.random.default_rng(seed)
    time = np.linspace(motion.breaks[0], motion.breaks[-1], round(rate * float(np.ptp(motion.breaks))) + 1)
    true = seen_in(feet, motion, p, time, name)
    sizes = np.where(np.array([k < 2 for k in range(N)]), noise.length, noise.angle)
    return StandingTrial(
        time,
        true.q + sizes * rng.normal(size=(len(time), N)),
        true.u + noise.rate * rng.normal(size=(len(time), N)),
        true.force + noise.force * rng.normal(size=(len(time), 2)),
        true.centre + noise.centre * rng.normal(size=len(time)),
        name,
    )
