"""A phase of the study as a control problem: what is tracked, what is kept small, what is assumed beforehand.

Each deviation counts in parts of its noise and in proportion to the samples a second, so that the cost, with the prior
of the parameters, is minus twice the logarithm of the joint posterior of motion and parameters over `RATE`.
Jerk is beside it as white noise of a size that standing up has; that weight is ours, the study's are not printed. The
ground's and the strap's forces follow from the states; in the study they are controls that are held to the laws.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicSpline

from geocontact.dynamics.collocation.certificate import (
    Certificate,
    Resimulation,
    certificate,
    fine_residual,
    resimulation,
)
from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import Bounds, ControlProblem, Course
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.symbols import residual, scaled
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.first_fit import first_fit
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import ContactParameter, bounds, usual
from geocontact.standing_up.trials import (
    FOOT_JERK,
    JOINT_JERK,
    StandingNoise,
    StandingTrial,
    problem_scales,
    standing_trial,
)

if TYPE_CHECKING:
    from casadi import SX


MOST_OF_IT = 0.99
"""Share from which on one term is nearly all of the cost."""


def cost_shares(phase: PhaseProblem, found: CollocationResult) -> dict[str, float]:
    """By term, integrated as the problem integrates it; the parameters' belief is left out. They add up to 1."""
    from casadi import Function, vertcat

    s = phase.control.system
    terms = Function("terms", [s.x, s.u, s.w, s.p], [vertcat(*phase.terms.values())])
    total = np.zeros(len(phase.terms))
    for trial, motion in zip(phase.control.trials, found.motions, strict=True):
        lengths = np.diff(motion.breaks)
        points = (motion.breaks[:-1, None] + lengths[:, None] * motion.scheme.points).ravel()
        weights = (lengths[:, None] * motion.scheme.weights).ravel()
        x = motion.states[:, 1:].reshape(len(points), -1)
        u = motion.controls.reshape(len(points), -1)
        given = (x.T, u.T, trial.inputs(points).T, np.tile(found.p[:, None], (1, len(points))))
        total += terms.map(len(points))(*given).full() @ weights
    return dict(zip(phase.terms, (total / total.sum()).tolist(), strict=True))


@dataclass(frozen=True, eq=False)
class JudgedMotion:
    """One trial.

    Parameters
    ----------
    certificate
        None where the search was ended before its time, so that there is nothing to certify.
    time
        Of the finer grid [s].
    force, moment
        Largest residual of the balance there [N], [N m].
    """

    certificate: Certificate | None
    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, " t"]
    moment: Float[np.ndarray, " t"]


def judged(
    stepper: Stepper,
    controlled: Sequence[int],
    turning: Sequence[bool],
    phase: PhaseProblem,
    found: CollocationResult,
    *,
    certify: bool = True,
) -> tuple[JudgedMotion, ...]:
    """Certificate of every trial; `controlled` are those of the stepper's inputs that were sought."""
    system = phase.control.system
    each = []
    for trial, motion in zip(phase.control.trials, found.motions, strict=True):
        again: Resimulation = resimulation(stepper, motion, found.p, trial.inputs, controlled)
        left = fine_residual(system, trial, motion, found.p, turning)
        seen = certificate(found.solved, system, trial, again, turning, left=left) if certify else None
        each.append(JudgedMotion(seen, left.time, left.force, left.moment))
    return tuple(each)


RATE = 100.0
"""Samples a second at which a deviation counts as itself [Hz]."""


@dataclass(frozen=True)
class PhaseSizes:
    """What the terms of a phase's cost are measured by.

    Parameters
    ----------
    noise
        Of one sample.
    rate
        Samples a second at which a deviation counts as itself [Hz].
    jerk
        Of the foot and of the joints [m/s^3, rad/s^3].
    weights
        Of what is kept small besides, by name.
    """

    noise: StandingNoise
    rate: float
    jerk: tuple[float, float]
    weights: Mapping[str, float]


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
    sizes
        Of the terms; None where the cost is of another kind.
    """

    control: ControlProblem
    terms: Mapping[str, SX]
    parameters: tuple[ContactParameter, ...]
    free: tuple[str, ...]
    sizes: PhaseSizes | None = None


def sizes_of(phase: PhaseProblem) -> PhaseSizes:
    """What its cost is measured by. ValueError where that is of another kind."""
    if phase.sizes is None:
        raise ValueError("this phase does not say what its cost is measured by")
    return phase.sizes


def standing_phase(
    model: StandingModel,
    subject: Subject,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    *,
    free: Sequence[str],
    tracks: Sequence[str],
    small: Mapping[str, SX],
    held: Float[np.ndarray, " p"] | None = None,
    start: Float[np.ndarray, " p"] | None = None,
    guess: Sequence[Course] | None = None,
    jerk_sizes: tuple[float, float] = (FOOT_JERK, JOINT_JERK),
    weights: Mapping[str, float] | None = None,
) -> PhaseProblem:
    """The problem of all trials at once.

    Parameters
    ----------
    free
        Names of the parameters that are sought; the others keep their usual values, or those of `held`.
    tracks
        Channels that the cost knows: coordinates, rates, force, centre, torque, strap.
    small
        Further integrands, by name.
    start
        Where the search of the parameters starts, unless at `first_fit`.
    guess
        Coordinates where the search of each motion starts, from its own start on; the recorded ones by default.
    jerk_sizes
        Of the foot and of the joints [m/s^3, rad/s^3].
    weights
        Of `small`; 1 by default.
    """
    from casadi import SX, sumsqr, vertcat

    weight = dict.fromkeys(small, 1.0) | dict(weights or {})
    e, n = model.equations, model.count
    channels = _channels(model, noise)
    width = {name: len(channels[name][1]) for name in tracks}
    recorded = SX.sym("recorded", width["strap"] if model.elsewhere and "strap" in tracks else 0)
    values, share, jerk = SX.sym("values", sum(width.values())), SX.sym("share"), SX.sym("jerk", n)
    terms, at = {}, 0
    for name in tracks:
        symbol, size = channels[name]
        off = residual(symbol, values[at : at + width[name], :], size)
        terms[name] = share * sumsqr(recorded * off if name == "strap" and recorded.numel() else off)
        at += width[name]
    seen = vertcat(values, recorded, share)
    sizes = np.r_[np.full(3, jerk_sizes[0]), np.full(n - 3, jerk_sizes[1])]
    terms |= {name: weight[name] * of for name, of in small.items()} | {"jerk": sumsqr(scaled(jerk, sizes))}
    system = jerk_controlled(
        e,
        controlled=range(n - 3),
        control_names=[f"{name} torque" for name in model.joints],
        data=seen,
        jerk=jerk,
        cost=sum(terms.values(), SX(0)),
        prior=belief(e.p, model.parameters, free),
        parameter_names=[each.name for each in model.parameters],
    )
    low, high = _bounds(model.parameters, free, held)
    smooth = [smooth_coordinates(trial) for trial in trials]
    begin = first_fit(model, trials, smooth, free, tracks, held) if start is None else start
    begin = np.clip(begin, low, high)
    made = tuple(
        standing_trial(trial.name, float(np.ptp(trial.time)), model, begin, course, _data(trial, tracks))
        for trial, course in zip(trials, guess or smooth, strict=True)
    )
    control = ControlProblem(system, made, (low, high), begin, *problem_scales(subject, n))
    measured = PhaseSizes(noise, RATE, jerk_sizes, weight)
    return PhaseProblem(control, terms, model.parameters, tuple(free), measured)


def _channels(model: StandingModel, noise: StandingNoise) -> dict[str, tuple[SX, Float[np.ndarray, " c"]]]:
    """What may be tracked, and the noise of each entry."""
    e, n = model.equations, model.count
    return {
        "coordinates": (e.q, model.per_coordinate(noise.length, noise.angle)),
        "rates": (e.u, np.full(n, noise.rate)),
        "force": (model.force, np.full(2, noise.force)),
        "centre": (model.centre, np.array([noise.centre])),
        "torque": (model.torques, np.full(n - 3, noise.torque)),
        "strap": (model.straps, np.full(model.straps.numel(), noise.strap)),
    }


def _bounds(
    parameters: Sequence[ContactParameter], free: Sequence[str], held: Float[np.ndarray, " p"] | None
) -> Bounds:
    """Bounds of what is searched; what is not free keeps its usual value, or that of `held`."""
    low, high = bounds(parameters, free)
    if held is None:
        return low, high
    fixed = np.array([each.name not in free for each in parameters])
    return np.where(fixed, held, low), np.where(fixed, held, high)


def belief(p: SX, parameters: Sequence[ContactParameter], free: Sequence[str]) -> SX:
    """Prior of the free parameters, as the cost counts it."""
    from casadi import SX

    middle, total = usual(parameters), SX(0)
    for k, each in enumerate(parameters):
        if each.name in free:
            total = total + ((p[k] - middle[k]) / each.sd) ** 2 / RATE
    return total


def _data(trial: StandingTrial, tracks: Sequence[str]) -> Course:
    """Chair's force where there is one, channels, what one sample counts; from the trial's own first time on.

    Of straps at several sites also which were recorded.
    """
    channels = {
        "coordinates": trial.q,
        "rates": trial.u,
        "force": trial.force,
        "centre": trial.centre,
        "torque": trial.torque,
        "strap": trial.straps,
    }
    columns = [each for name in tracks if (each := channels[name]) is not None]
    if len(columns) < len(tracks):
        raise ValueError(f"{trial.name} lacks a channel of {', '.join(tracks)}")
    if "strap" in tracks and trial.straps is not None and trial.elsewhere:
        columns[list(tracks).index("strap")] = np.nan_to_num(trial.straps)
        columns.append(np.isfinite(trial.straps).astype(float))
    chair = [] if trial.chair is None else [trial.chair]
    course = CubicSpline(trial.time - trial.time[0], np.column_stack([*chair, *columns]))
    share = trial.rate / RATE
    return lambda time: np.column_stack([course(time), np.full(len(time), share)])


DEGREE = 7
"""Degree of the polynomials through the coordinates."""


def smooth_coordinates(
    trial: StandingTrial, degree: int = DEGREE
) -> Callable[[Float[np.ndarray, " t"]], Float[np.ndarray, "t n"]]:
    """Polynomials through the coordinates: where the search starts, accelerations must not be noise."""
    fits = [Polynomial.fit(trial.time - trial.time[0], q, degree) for q in trial.q.T]

    def coordinates(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        return np.column_stack([fit(time) for fit in fits])

    return coordinates
