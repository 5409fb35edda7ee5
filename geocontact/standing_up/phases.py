"""Phases A, B and C of the study: parameters of the feet, of the strap, and the prediction of a trial that was not
used.

Tracks coordinates, rates, ground reaction force and centre of pressure; little torque and jerk besides (Table I of the
study, interface forces none).

Tracks what phase A does, and the torques of all joints and the strap's normal force besides; the squared energy of the
strap's other components is kept small (Table I of the study).

Tracks ground reaction force, centre of pressure and torques; jerk and the squared energy of the whole strap are kept
small (Table I of the study). Coordinates and strap are not seen: only the first and the last state are given, within
what a sample is off. The search starts on a rise of least jerk between the two, not on the recorded motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.problem import Bounds, Course
from geocontact.standing_up.chain import LAW, Subject
from geocontact.standing_up.exoskeleton import STRAP
from geocontact.standing_up.phase import DEGREE, PhaseProblem, smooth_coordinates, standing_phase
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import SPRINGS, STRAP_SITES, usual
from geocontact.standing_up.trials import SHIPPED, CostWeights, StandingNoise, StandingTrial

SLACK = -30.0
"""What is searched of a strap's stiffnesses that are as good as 0."""
TRACKS = ("coordinates", "rates", "force", "centre")


def phase_a(
    model: StandingModel,
    subject: Subject,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    *,
    free: Sequence[str] = LAW,
    tracks: Sequence[str] = TRACKS,
    start: Float[np.ndarray, " p"] | None = None,
    weights: CostWeights = SHIPPED,
) -> PhaseProblem:
    """The problem whose solution has the parameters; see `standing_phase`.

    An exoskeleton's straps have no stiffness here: its chain stands up by its own torques, as in the study.
    """
    from casadi import sumsqr

    small = {"torques": sumsqr(model.torques)}
    held = usual(model.parameters)
    springs = {name for site in STRAP_SITES for name in site.names[: len(SPRINGS)]}
    held[[each.name in springs for each in model.parameters]] = SLACK
    return standing_phase(
        model,
        subject,
        trials,
        noise,
        free=free,
        tracks=tracks,
        small=small,
        held=held,
        start=start,
        jerk_sizes=weights.jerk,
        weights={"torques": weights.torques},
    )


TRACKS_B = ("coordinates", "rates", "force", "centre", "torque", "strap")


def phase_b(
    model: StandingModel,
    subject: Subject,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    feet: Float[np.ndarray, " f"],
    *,
    free: Sequence[str] = STRAP,
    tracks: Sequence[str] = TRACKS_B,
    start: Float[np.ndarray, " s"] | None = None,
    weights: CostWeights = SHIPPED,
) -> PhaseProblem:
    """The problem whose solution has the strap's parameters.

    Parameters
    ----------
    feet
        What is searched of the feet's parameters, as phase A found it.
    start
        Where the search of the strap's parameters starts, unless at the prior.
    """
    held = np.r_[feet, usual(model.parameters[len(feet) :])]
    begin = held if start is None else np.r_[feet, start]
    return standing_phase(
        model,
        subject,
        trials,
        noise,
        free=free,
        tracks=tracks,
        small={"energy": model.energy**2},
        held=held,
        start=begin,
        jerk_sizes=weights.jerk,
        weights={"energy": weights.energy},
    )


TRACKS_C = ("force", "centre", "torque")
WITHIN = 3.0
"""Standard deviations within which the first and the last state are given."""


def phase_c(
    model: StandingModel,
    subject: Subject,
    trial: StandingTrial,
    noise: StandingNoise,
    p: Float[np.ndarray, " p"],
    *,
    tracks: Sequence[str] = TRACKS_C,
    weights: CostWeights = SHIPPED,
) -> PhaseProblem:
    """The problem whose solution is the predicted motion; `p` is what is searched of all parameters."""
    course = smooth_coordinates(trial)
    phase = standing_phase(
        model,
        subject,
        [trial],
        noise,
        free=(),
        tracks=tracks,
        small={"energy": (model.energy + model.normal_energy) ** 2},
        held=p,
        start=p,
        jerk_sizes=weights.jerk,
        weights={"energy": weights.energy},
        guess=[_between(course, float(np.ptp(trial.time)))],
    )
    start, end = (_bounds_at(model, noise, trial, course, at) for at in (0, -1))
    only = replace(phase.control.trials[0], start=start, end=end)
    return replace(phase, control=replace(phase.control, trials=(only,)))


def _between(course: Course, seconds: float) -> Course:
    """The rise of least jerk between the first and the last posture."""
    first, last = course(np.zeros(1)), course(np.full(1, seconds))

    def coordinates(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        s = np.clip(time / seconds, 0.0, 1.0)[:, None]
        return np.asarray(first + (last - first) * (10 * s**3 - 15 * s**4 + 6 * s**5))

    return coordinates


def _bounds_at(model: StandingModel, noise: StandingNoise, trial: StandingTrial, course: Course, at: int) -> Bounds:
    """Bounds of the first (0) or last (-1) state: about the smoothed coordinates and the recorded rates; accelerations
    are free.

    Where no rates were recorded they are the slopes of the smoothed coordinates, with the error that these have.
    """
    h, n = 1e-3, model.count
    time = float(trial.time[at] - trial.time[0])
    q = course(np.array([time]))[0]
    places = model.per_coordinate(noise.length, noise.angle)
    if trial.u.any():
        u, rates = trial.u[at], np.full(n, noise.rate)
    else:
        u = (course(np.array([time + h])) - course(np.array([time - h])))[0] / (2.0 * h)
        rates = places * slope_error(trial.time)
    room = WITHIN * np.r_[places, rates]
    wide = np.full(n, np.inf)
    return np.r_[np.r_[q, u] - room, -wide], np.r_[np.r_[q, u] + room, wide]


def slope_error(time: Float[np.ndarray, " t"], degree: int = DEGREE) -> float:
    """Standard deviation of the slope at either end of a polynomial through white noise of deviation 1 [1/s].

    By least squares, sqrt(d' (X' X)^-1 d) with the powers X of the time and their slopes d at its end.
    """
    scaled = 2.0 * (time - time[0]) / float(np.ptp(time)) - 1.0
    powers = np.vander(scaled, degree + 1, increasing=True)
    slopes = np.arange(degree + 1) * 2.0 / float(np.ptp(time))
    return float(np.sqrt(slopes @ np.linalg.solve(powers.T @ powers, slopes)))
