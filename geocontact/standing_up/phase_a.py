"""Phase A: parameters of the feet from passive trials, all at once.

Tracks coordinates, rates, ground reaction force and centre of pressure; little torque and jerk besides (Table I of the
study, interface forces none). Here the ground's force follows from the states; in the study it is a control that is
held to the law. Each deviation counts in parts of its noise and in proportion to the samples a second, so that the
cost, with what is believed of the parameters, is minus twice the logarithm of their posterior over `RATE`; torque and
jerk are beside it, with weights that are ours, for the study's are not printed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicSpline

from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlProblem, Course
from geocontact.standing_up.chain import JOINTS, Subject
from geocontact.standing_up.contact_parameter import ContactParameter, bounds, usual
from geocontact.standing_up.feet import FOOT_PARAMETERS, LAW, FeetOnGround
from geocontact.standing_up.first_fit import first_fit
from geocontact.standing_up.trials import N, StandingNoise, StandingTrial, problem_scales, standing_trial

if TYPE_CHECKING:
    from casadi import SX

LITTLE_TORQUE = 1e-6
JERK = np.array([5.0, 5.0, 5.0, 20.0, 20.0, 20.0])
"""Size of the jerk of each coordinate while standing up [m/s^3, rad/s^3], roughly; larger ones let the motion follow the
noise of plate and encoders, and with it the parameters."""
RATE = 100.0
"""Samples a second at which a deviation counts as itself [Hz]."""
TRACKS = ("coordinates", "rates", "force", "centre")


@dataclass(frozen=True)
class PhaseProblem:
    """A phase as a control problem, and what its cost consists of.

    Parameters
    ----------
    control
        Its solution has the parameters.
    terms
        Integrands of the cost, by name.
    parameters
        All of them.
    free
        Names of those that are sought.
    """

    control: ControlProblem
    terms: Mapping[str, SX]
    parameters: tuple[ContactParameter, ...]
    free: tuple[str, ...]


def phase_a(
    feet: FeetOnGround,
    subject: Subject,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    *,
    free: Sequence[str] = LAW,
    tracks: Sequence[str] = TRACKS,
    start: Float[np.ndarray, " p"] | None = None,
) -> PhaseProblem:
    """The problem of all trials at once.

    Parameters
    ----------
    free
        Names of the parameters that are sought; the others keep their usual values.
    tracks
        Which channels the cost knows, of `TRACKS`.
    start
        Where the search of the parameters starts, unless at `first_fit`.
    """
    from casadi import SX, sumsqr, vertcat

    e, seen, jerk = feet.equations, SX.sym("seen", 2 * N + 4), SX.sym("jerk", N)
    sizes = np.r_[[noise.length] * 2, [noise.angle] * 4, [noise.rate] * N, [noise.force] * 2, noise.centre]
    off = (vertcat(e.q, e.u, feet.force, feet.centre) - seen[:-1, :]) / sizes
    places = {"coordinates": (0, N), "rates": (N, 2 * N), "force": (2 * N, 2 * N + 2), "centre": (2 * N + 2, 2 * N + 3)}
    terms = {name: seen[2 * N + 3] * sumsqr(off[slice(*places[name]), :]) for name in tracks}
    terms |= {"torque": LITTLE_TORQUE * sumsqr(e.w), "jerk": sumsqr(jerk / JERK)}
    system = jerk_controlled(
        e,
        controlled=range(3),
        control_names=JOINTS,
        data=seen,
        jerk=jerk,
        cost=sum(terms.values(), SX(0)),
        prior=belief(e.p, FOOT_PARAMETERS, free),
        parameter_names=[each.name for each in FOOT_PARAMETERS],
    )
    low, high = bounds(FOOT_PARAMETERS, free)
    smooth = [_smooth(trial) for trial in trials]
    begin = np.clip(first_fit(feet, trials, smooth, free, tracks) if start is None else start, low, high)
    made = [
        standing_trial(trial.name, float(np.ptp(trial.time)), feet, begin, course, _data(trial))
        for trial, course in zip(trials, smooth, strict=True)
    ]
    control = ControlProblem(system, tuple(made), (low, high), begin, *problem_scales(subject))
    return PhaseProblem(control, terms, FOOT_PARAMETERS, tuple(free))


def belief(p: SX, parameters: Sequence[ContactParameter], free: Sequence[str]) -> SX:
    """What is believed of the free parameters beforehand, as the cost counts it."""
    from casadi import SX

    middle, total = usual(parameters), SX(0)
    for k, each in enumerate(parameters):
        if each.name in free:
            total = total + ((p[k] - middle[k]) / each.sd) ** 2 / RATE
    return total


def _data(trial: StandingTrial) -> Course:
    """Channels, and what one sample counts, from the trial's own first time on."""
    columns = np.column_stack([trial.q, trial.u, trial.force, trial.centre])
    course = CubicSpline(trial.time - trial.time[0], columns)
    share = trial.rate / RATE
    return lambda time: np.column_stack([course(time), np.full(len(time), share)])


def _smooth(trial: StandingTrial) -> Callable[[Float[np.ndarray, " t"]], Float[np.ndarray, "t 6"]]:
    """Polynomials of degree 7 through the coordinates: where the search starts, accelerations must not be noise."""
    fits = [Polynomial.fit(trial.time - trial.time[0], q, 7) for q in trial.q.T]

    def coordinates(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 6"]:
        return np.column_stack([fit(time) for fit in fits])

    return coordinates
