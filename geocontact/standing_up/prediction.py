"""A trial that was not used, predicted with parameters that are known: phase C, solved, refined and certified."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.solve import Progress, SolverOptions, refined, rough, solve
from geocontact.standing_up.chain import FOOT_PARAMETERS, Subject
from geocontact.standing_up.numbers_that_ran import (
    FROM_FILE,
    PERTURBED,
    Ran,
    end_numbers,
    model_numbers,
    parameter_numbers,
    search_numbers,
    size_numbers,
)
from geocontact.standing_up.phase import PhaseProblem, judged, sizes_of
from geocontact.standing_up.phases import TRACKS_C, phase_c
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import ContactParameter, StrapSite
from geocontact.standing_up.trial_result import TrialResult, trial_result
from geocontact.standing_up.trials import SHIPPED, CostWeights, StandingNoise, StandingTrial, seen_in

ALL = "all given"
GIVEN: Mapping[str, tuple[str, ...]] = {
    ALL: TRACKS_C,
    "without ground reaction": ("torque",),
    "without torques": ("force", "centre"),
}
"""Channels that a predictor is given, by its name."""


def contact_parameters(sites: Sequence[StrapSite]) -> tuple[ContactParameter, ...]:
    """Parameters of the feet, then of the straps at these sites, in the order of `strapped`'s model."""
    return (*FOOT_PARAMETERS, *(each for site in sites for each in site.parameters))


@dataclass(frozen=True, eq=False)
class PredictedTrial:
    """One trial by one predictor.

    Parameters
    ----------
    name
        Of the predictor.
    model, phase
        What moved, and the problem that was solved.
    motion, p, objective
        Its solution, and what it costs.
    ending
        How the search ended, in words.
    seconds
        CPU time.
    """

    name: str
    model: StandingModel
    phase: PhaseProblem
    motion: CollocatedMotion
    p: Float[np.ndarray, " p"]
    objective: float
    trial: TrialResult
    solved: bool
    ending: str
    iterations: int
    seconds: float

    @property
    def certified(self) -> bool:
        """Whether the motion passes."""
        return self.trial.certified


def predicted_trial(
    name: str,
    model: StandingModel,
    subject: Subject,
    trial: StandingTrial,
    noise: StandingNoise,
    p: Float[np.ndarray, " p"],
    options: SolverOptions,
    *,
    nodes: float = 45.0,
    tracks: Sequence[str] = TRACKS_C,
    weights: CostWeights = SHIPPED,
    progress: Progress | None = None,
) -> PredictedTrial:
    """The motion from a trial's first and last posture and from the channels of `tracks`; certified where it is solved.

    Parameters
    ----------
    name
        Of the predictor.
    model
        Such as `strapped` makes; `p` is what is searched of all its parameters.
    noise
        Standard deviations of the recorded channels.
    options
        Of the solver; its intervals do not count.
    nodes
        Intervals a second where the search starts; those that leave too much of the balance are halved.
    """
    phase = phase_c(model, subject, trial, noise, p, tracks=tracks, weights=weights)
    mesh = np.linspace(0.0, 1.0, round(nodes * float(trial.time[-1])) + 1)
    coarse = solve(phase.control, rough(options), meshes=(mesh,), progress=progress)
    found = refined(phase.control, coarse, options, model.turning, progress=progress)
    motion = found.motions[0]
    (seen,) = judged(model.stepper, range(model.count - 3), model.turning, phase, found, certify=found.solved)
    result = trial_result(trial, motion, seen, partial(seen_in, model, motion, found.p, name=trial.name))
    ended = found.solved, found.ending, found.iterations, found.seconds
    return PredictedTrial(name, model, phase, motion, found.p, found.objective, result, *ended)


def prediction_numbers(predictions: Sequence[PredictedTrial]) -> list[Ran]:
    """Model, parameters and cost once; parameters of a predictor that has others; the mesh of each motion."""
    first = predictions[0]
    rows = model_numbers(first.model) + parameter_numbers(first.phase.parameters, first.p, note=FROM_FILE)
    rows += size_numbers(sizes_of(first.phase)) + end_numbers(first.phase.control)
    others = {one.name: one for one in predictions if not np.array_equal(one.p, first.p)}
    for one in others.values():
        rows += parameter_numbers(one.phase.parameters, one.p, f"{one.name} ", note=PERTURBED)
    for one in predictions:
        rows += search_numbers([one.motion], [one.trial.recorded], f"{one.name} ")
    return rows
