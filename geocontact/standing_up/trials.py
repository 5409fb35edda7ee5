"""A synthetic passive trial: the feet's model itself stands up, so that what is planted can be found again.

Not a recording, and no test of the model's form: calibration and truth share their equations. Noise is white; its
sizes and the course of the angles are invented.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlledTrial, ControlProblem, Course
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
from geocontact.dynamics.symbols import residual
from geocontact.standing_up.chain import COMPONENTS, COORDINATES, PLANTED, Subject
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import THIGH_STRAP, StrapSite

SEATED = np.radians([22.0, 70.0, 45.0])
"""Lean of shank forwards, thigh backwards and trunk forwards at seat-off [rad]."""
STANDING = np.radians([4.0, 4.0, 4.0])
SETTLED = 0.006
"""Depth of the spheres where the search starts [m]."""
COARSE = 10
"""Intervals of a first search, whose answer is where the finer one starts."""
MOST_TORQUE = 1000.0
"""Torque of both legs, at the most [N m]."""
UNPOWERED = 1e-3
"""Weight of the exoskeleton's torques beyond its assistance [1/(N m)^2]: straps carry it where they can."""
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
    torque
        Of the joints of both legs [N m]; None where it is not recorded.
    strap
        Normal force of one leg's strap at the thigh on the person [N]; None where it is not recorded.
    chair
        Force of the chair on the person, forwards and up [N], and its moment about the ground's origin [N m]; None in a
        trial from seat-off on.
    elsewhere
        Normal force of one strap at each further site by its name [N]; no number where it is not recorded.
    shear
        Force of the same strap at the thigh on the person along it, towards the hip positive [N], by load cells or a
        two-axis mat; None where it is not recorded.
    """

    time: Float[np.ndarray, " t"]
    q: Float[np.ndarray, "t n"]
    u: Float[np.ndarray, "t n"]
    force: Float[np.ndarray, "t 2"]
    centre: Float[np.ndarray, " t"]
    name: str = "trial"
    torque: Float[np.ndarray, "t j"] | None = None
    strap: Float[np.ndarray, " t"] | None = None
    chair: Float[np.ndarray, "t 3"] | None = None
    elsewhere: Mapping[str, Float[np.ndarray, " t"]] = field(default_factory=dict)
    shear: Float[np.ndarray, " t"] | None = None

    @property
    def straps(self) -> Float[np.ndarray, "t s"] | None:
        """Normal force of one strap at each site [N]."""
        return None if self.strap is None else np.column_stack([self.strap, *self.elsewhere.values()])

    @property
    def rate(self) -> float:
        """Samples a second."""
        return float((len(self.time) - 1) / np.ptp(self.time))


@dataclass(frozen=True)
class StandingNoise:
    """Standard deviations: of lengths [m], angles [rad], rates [m/s, rad/s], force [N], centre [m].

    And of torques of the joints [N m], a strap's normal force and its shear [N].
    """

    length: float = 5e-4
    angle: float = np.radians(0.3)
    rate: float = 0.02
    force: float = 2.0
    centre: float = 1e-3
    torque: float = 2.0
    strap: float = 1.0
    shear: float = 1.0


FOOT_JERK, JOINT_JERK = 20.0, 60.0
"""Sizes of the jerk [m/s^3, rad/s^3], several times those of a smooth rise.

Smaller ones bend the motion and with it the parameters, larger ones let both follow the noise.
"""
LITTLE_TORQUE, LITTLE_ENERGY = 1e-6, 1e-3
"""Weights of the torques' squares [1/(N m)^2] and of the squared energy [1/J^2]; ours, the study's are not printed."""


@dataclass(frozen=True)
class CostWeights:
    """What of the cost no noise weighs.

    Parameters
    ----------
    torques
        Of the squared torques, in phase A [1/(N m)^2].
    energy
        Of the squared energy of the straps, in phases B and C [1/J^2].
    foot_jerk, joint_jerk
        Sizes of the jerk that count as 1 [m/s^3, rad/s^3].
    """

    torques: float = LITTLE_TORQUE
    energy: float = LITTLE_ENERGY
    foot_jerk: float = FOOT_JERK
    joint_jerk: float = JOINT_JERK

    @property
    def jerk(self) -> tuple[float, float]:
        """Sizes of the jerk of foot and joints."""
        return self.foot_jerk, self.joint_jerk


SHIPPED = CostWeights()


@dataclass(frozen=True, eq=False)
class StandingUpTrials:
    """Trials of one person.

    Parameters
    ----------
    exoskeleton
        Whether it was worn, so that its strap is calibrated too.
    free, tracks
        Names of the feet's parameters, and channels.
    sites
        Where straps are, if an exoskeleton was worn.
    weights
        Of the cost, besides the noise.
    one_leg
        Whether trials are stances of one leg, and their chair the load of the rest of the body.
    """

    subject: Subject
    noise: StandingNoise
    trials: tuple[StandingTrial, ...]
    exoskeleton: bool
    free: tuple[str, ...]
    tracks: tuple[str, ...]
    sites: tuple[StrapSite, ...] = (THIGH_STRAP,)
    weights: CostWeights = SHIPPED
    one_leg: bool = False

    @property
    def seated(self) -> bool:
        """Whether a trial begins on the chair."""
        return any(trial.chair is not None for trial in self.trials)


def with_chairs(trials: Sequence[StandingTrial]) -> tuple[StandingTrial, ...]:
    """Where one begins on the chair, the others have one that carries nothing."""
    if all(trial.chair is None for trial in trials):
        return tuple(trials)
    return tuple(
        trial if trial.chair is not None else replace(trial, chair=np.zeros((len(trial.time), COMPONENTS)))
        for trial in trials
    )


def rising(seconds: float, seated: Float[np.ndarray, " 3"] = SEATED, p: Float[np.ndarray, " p"] = PLANTED) -> Course:
    """Coordinates of a person by the polynomial of least jerk, seat-off to standing, the foot flat on the ground."""
    height = p[3] - SETTLED

    def course(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 6"]:
        s = np.clip(time / seconds, 0.0, 1.0)[:, None]
        shank, thigh, trunk = (seated + (STANDING - seated) * (10 * s**3 - 15 * s**4 + 6 * s**5)).T
        foot = np.tile([0.0, height, 0.0], (len(time), 1))
        return np.column_stack([foot, -shank, shank + thigh, -thigh - trunk])

    return course


def standing_up(
    model: StandingModel,
    subject: Subject,
    *,
    seconds: float = 1.5,
    seated: Float[np.ndarray, " 3"] = SEATED,
    planted: Float[np.ndarray, " p"] = PLANTED,
    assistance: float = 0.0,
    intervals: int = 50,
    chair: Course | None = None,
    down: bool = False,
    squat: bool = False,
) -> tuple[ControlProblem, CollocationResult]:
    """The motion with planted parameters closest to `rising`, with little jerk and torque; an exoskeleton along.

    `assistance` is what the exoskeleton's torques are to be of the person's. Coordinates after both chains', such as a
    toe joint's, have no torque and are to stay at 0. `chair` is the force of one over time, for a model that has it.
    `down` has the person sit down instead, the same course from its end; `squat` goes down and up again, in half
    of the time each.
    """
    from casadi import SX, sumsqr

    n, e = model.count, model.equations
    torques = len(model.joints)
    wanted, jerk = SX.sym("wanted", n), SX.sym("jerk", n)
    off = residual(e.q, wanted, model.per_coordinate(0.01, np.radians(2.0)))
    torque = model.torques
    extra = torque[3:, :] - assistance * torque[:3, :] if n > N else SX(0)
    cost = sumsqr(off) + 1e-5 * sumsqr(jerk) + 1e-6 * sumsqr(torque) + UNPOWERED * sumsqr(extra)
    system = jerk_controlled(
        e,
        controlled=range(torques),
        control_names=model.joints,
        data=wanted,
        jerk=jerk,
        cost=cost,
        parameter_names=[each.name for each in model.parameters],
    )
    alone = rising(seconds, seated, planted)

    def course(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        # in a squat from the end to the beginning of the course and back, twice as fast
        q = alone(np.abs(seconds - 2.0 * time) if squat else seconds - time if down else time)
        return np.hstack([q, q[:, 3 : 3 + torques - 3], np.zeros((len(q), n - 3 - torques))])

    def given(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t w"]:
        return course(time) if chair is None else np.hstack([chair(time), course(time)])

    trial = standing_trial("synthetic", seconds, model, planted, course, given, range(3, 3 + torques))
    of_balance, of_states, of_controls = problem_scales(subject, n)
    scales = of_balance, of_states, of_controls[: n + torques]
    problem = ControlProblem(system, (trial,), (planted, planted), planted, *scales)
    coarse = solve(problem, SolverOptions("legendre", 4, COARSE, 1e-7))
    return problem, solve(problem, SolverOptions("legendre", 4, intervals, 1e-7), warm=coarse)


def standing_trial(
    name: str,
    seconds: float,
    model: StandingModel,
    p: Float[np.ndarray, " p"],
    guess: Course,
    data: Course,
    driven: Sequence[int] | None = None,
) -> ControlledTrial:
    """No bounds, free ends; the search starts on courses of the coordinates and the torques that they need.

    Parameters
    ----------
    driven
        Coordinates whose torques are sought; those of all joints by default.
    """
    from casadi import Function

    e, n = model.equations, model.count
    by_torque = list(range(3, n) if driven is None else driven)
    needed = Function("needed", [e.q, e.u, e.a, e.w, e.p], [-e.balance[by_torque, :]])

    def guess_x(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t x"]:
        h = 1e-2
        before, at, after = (guess(np.clip(time + k * h, 0.0, seconds)) for k in (-1, 0, 1))
        return np.hstack([at, (after - before) / (2 * h), (after - 2 * at + before) / h**2])

    def guess_u(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t u"]:
        x, many = guess_x(time), needed.map(len(time))
        none = np.zeros((e.w.numel(), len(time)))
        torque = many(x[:, :n].T, x[:, n : 2 * n].T, x[:, 2 * n :].T, none, np.tile(p[:, None], (1, len(time))))
        return np.hstack([np.zeros((len(time), n)), np.clip(torque.full().T, -MOST_TORQUE, MOST_TORQUE)])

    wide, most = np.full(3 * n, np.inf), np.full(n + len(by_torque), np.inf)
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
    subject: Subject, count: int = N
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " x"], Float[np.ndarray, " u"]]:
    """Scales of the balance: a tenth of body weight, along and about; of the states and the controls what standing up
    has.
    """
    turns = count - 3
    place = np.r_[[0.01, 0.01, 0.05], np.ones(turns)]
    speed = np.r_[[0.1, 0.1, 0.5], np.ones(turns)]
    change = np.r_[[1.0, 1.0, 5.0], np.full(turns, 5.0)]
    jerk = np.r_[[20.0, 20.0, 100.0], np.full(turns, 50.0)]
    return np.full(count, subject.mass), np.r_[place, speed, change], np.r_[jerk, np.full(turns, 100.0)]


def seen_in(
    model: StandingModel, motion: CollocatedMotion, p: Float[np.ndarray, " p"], time: Float[np.ndarray, " t"], name: str
) -> StandingTrial:
    """What perfect encoders, plates and mats see of a motion at times [s]."""
    from casadi import Function

    e, n, x = model.equations, model.count, motion.state(time)
    seen = Function("seen", [e.q, e.u, e.p], [model.force, model.centre, model.straps, model.shear]).map(len(time))
    given = (x[:, :n].T, x[:, n : 2 * n].T, np.tile(p[:, None], (1, len(time))))
    force, centre, straps, along = (each.full() for each in seen(*given))
    shear = along[0] if len(along) else None
    worn, elsewhere = straps[0] if len(straps) else None, dict(zip(model.elsewhere, straps[1:], strict=True))
    torque = motion.control(time)[:, n:]
    return StandingTrial(
        time, x[:, :n], x[:, n : 2 * n], force.T, centre[0], name, torque, worn, elsewhere=elsewhere, shear=shear
    )


def recorded(
    model: StandingModel,
    motion: CollocatedMotion,
    p: Float[np.ndarray, " p"],
    rate: float,
    noise: StandingNoise,
    seed: int,
    name: str = "trial",
) -> StandingTrial:
    """What encoders, plates and mats record of a motion, `rate` samples a second."""
    time = np.linspace(motion.breaks[0], motion.breaks[-1], round(rate * float(np.ptp(motion.breaks))) + 1)
    return with_noise(seen_in(model, motion, p, time, name), model, noise, seed)


def with_noise(true: StandingTrial, model: StandingModel, noise: StandingNoise, seed: int) -> StandingTrial:
    """A trial that was seen perfectly, with white noise on every channel."""
    rng = np.random.default_rng(seed)

    def off(of: Float[np.ndarray, "t ..."], size: float | Float[np.ndarray, " n"]) -> Float[np.ndarray, "t ..."]:
        return np.asarray(of + size * rng.normal(size=of.shape))

    q = off(true.q, model.per_coordinate(noise.length, noise.angle))
    u, force, centre = off(true.u, noise.rate), off(true.force, noise.force), off(true.centre, noise.centre)
    torque = None if true.torque is None else off(true.torque, noise.torque)
    strap = None if true.strap is None else off(true.strap, noise.strap)
    elsewhere = {name: off(force, noise.strap) for name, force in true.elsewhere.items()}
    shear = None if true.shear is None else off(true.shear, noise.shear)
    return StandingTrial(true.time, q, u, force, centre, true.name, torque, strap, elsewhere=elsewhere, shear=shear)
