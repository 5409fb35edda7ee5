"""Every held-out trial sought by every predictor; what is done is kept at once, and Ctrl-C keeps what there is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.certificate_words import not_certified
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.predicted_trial import ALL, PredictedTrial
from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.dynamics.collocation.refinement import refined
from geocontact.dynamics.collocation.solve import SolverOptions, solve, stopped_by_ctrl_c
from geocontact.standing_up.calibrated_phase import INTERRUPTED
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.judged import judged
from geocontact.standing_up.phase_c import TRACKS_C, phase_c
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingTrial, seen_in

TOLERANCE = 1e-7
GIVEN: dict[str, tuple[str, ...]] = {
    ALL: TRACKS_C,
    "without ground reaction": ("torque",),
    "without torques": ("force", "centre"),
}
"""Channels by what the predictor is called."""
Keep = Callable[[Sequence[PredictedTrial]], None]
"""Told of all predictions that there are, as soon as a trial is done."""


@dataclass
class _Asked:
    """Whether Ctrl-C was pressed, also between two searches."""

    stop: bool = False


def predicted(
    given: HeldOutTrials, o: StandingPredictOptions, record: Record, keep: Keep
) -> tuple[PredictedTrial, ...]:
    """Trials outer, predictors inner; searches without an answer and motions without a certificate are warned of.

    Ctrl-C ends the search that is going on, keeps its last iterate and begins no other.
    """
    model, predictions = (
        strapped(given.trials.subject, given.known.sites, seated=given.trials.seated),
        list[PredictedTrial](),
    )
    trials, asked = given.trials.trials, _Asked()
    with record.listener.stages("predicting") as stage, stopped_by_ctrl_c(asked):
        for k, trial in enumerate(trials, 1):
            for predictor in GIVEN.items():
                where = f"trial {k} of {len(trials)}, {trial.name} {predictor[0]}"
                one = _predicted(model, given, trial, predictor, o, partial(_at, stage, where))
                predictions.append(one)
                asked.stop |= one.ending.startswith(INTERRUPTED)
                if asked.stop:
                    break
            if asked.stop:
                break
            keep(predictions)
    _doubt(record, predictions, len(trials))
    return tuple(predictions)


def _at(stage: Callable[[str], None], where: str, told: str) -> None:
    stage(f"{where}, {told}")


def complete(predictions: Sequence[PredictedTrial], trials: int) -> bool:
    """Whether so many trials are predicted by every predictor, and every motion is certified."""
    return len(predictions) == trials * len(GIVEN) and all(one.certified for one in predictions)


def _doubt(record: Record, predictions: Sequence[PredictedTrial], trials: int) -> None:
    for one in predictions:
        place = f"{one.trial.recorded.name} {one.name}"
        if not one.solved:
            record.warn(f"{place} ended without an answer: {one.ending}; it is its last iterate")
        elif one.trial.judged.certificate is not None and not one.trial.judged.certificate.converged:
            record.warn(not_certified(place, one.trial.judged.certificate))
    if len(predictions) < trials * len(GIVEN):
        last, ended = predictions[-1], [one for one in predictions if not one.ending.startswith(INTERRUPTED)]
        where = f"the last search was {last.trial.recorded.name} {last.name}"
        record.warn(f"interrupted: {len(ended) // len(GIVEN)} of {trials} trials have every predictor; {where}")


def _predicted(
    model: StandingModel,
    given: HeldOutTrials,
    trial: StandingTrial,
    predictor: tuple[str, tuple[str, ...]],
    o: StandingPredictOptions,
    stage: Callable[[str], None],
) -> PredictedTrial:
    name, tracks = predictor
    phase = phase_c(model, given.trials.subject, trial, given.trials.noise, given.p, tracks=tracks)
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)

    def told(iteration: int, objective: float, residual: float) -> None:
        stage(f"iteration {iteration}, objective {objective:.5g}, residual {residual:.2g}")

    mesh = np.linspace(0.0, 1.0, round(o.nodes * float(trial.time[-1])) + 1)
    coarse = solve(phase.control, options, meshes=(mesh,), progress=told)
    found = refined(phase.control, coarse, options, model.turning, progress=told)
    motion, n = found.motions[0], model.count
    (seen,) = judged(model.equations, range(n - 3), model.turning, phase, found, certify=found.solved)
    result = TrialResult(
        recorded=trial,
        model=seen_in(model, motion, found.p, trial.time, trial.name),
        points=seen_in(model, motion, found.p, motion.held_times, trial.name),
        acceleration=motion.state(motion.held_times)[:, 2 * n : 3 * n],
        judged=seen,
    )
    ended = found.solved, found.ending, found.iterations, found.seconds
    return PredictedTrial(name, model, phase, motion, found.p, found.objective, result, *ended)
