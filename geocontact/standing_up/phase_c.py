"""Phase C: motion and strap force of a trial that was not used, with all parameters held.

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
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.phase import PhaseProblem, smooth_coordinates, standing_phase
from geocontact.standing_up.phase_b import LITTLE_ENERGY
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingNoise, StandingTrial

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
        weights={"energy": LITTLE_ENERGY},
        guess=[_between(course, float(np.ptp(trial.time)))],
    )
    seconds = float(np.ptp(trial.time))
    start, end = (_given(model, noise, course, at) for at in (0.0, seconds))
    only = replace(phase.control.trials[0], start=start, end=end)
    return replace(phase, control=replace(phase.control, trials=(only,)))


def _between(course: Course, seconds: float) -> Course:
    """The rise of least jerk between the first and the last posture."""
    first, last = course(np.zeros(1)), course(np.full(1, seconds))

    def coordinates(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        s = np.clip(time / seconds, 0.0, 1.0)[:, None]
        return np.asarray(first + (last - first) * (10 * s**3 - 15 * s**4 + 6 * s**5))

    return coordinates


def _given(model: StandingModel, noise: StandingNoise, course: Course, at: float) -> Bounds:
    """Bounds of coordinates and rates about the smoothed recording at a time; accelerations are free."""
    h, n = 1e-3, model.count
    q = course(np.array([at]))[0]
    u = (course(np.array([at + h])) - course(np.array([at - h])))[0] / (2.0 * h)
    room = WITHIN * np.r_[model.per_coordinate(noise.length, noise.angle), np.full(n, noise.rate)]
    wide = np.full(n, np.inf)
    return np.r_[np.r_[q, u] - room, -wide], np.r_[np.r_[q, u] + room, wide]
