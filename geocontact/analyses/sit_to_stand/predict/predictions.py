"""Held-out trials sought by every predictor with calibrated parameters: what is read, the searches, and tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, listener, reserve
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.standing_trials import StandingUpTrials, standing_trials
from geocontact.analyses.sit_to_stand.trial_result import (
    FROM_FILE,
    TrialResult,
    certificate_rows,
    mesh_table,
    not_certified,
    sizes_of,
)
from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.solve import SolverOptions, refined, solve, stopped_by_ctrl_c
from geocontact.io.recordings.spheres import read_contact_parameters
from geocontact.standing_up.calibrated_phase import INTERRUPTED
from geocontact.standing_up.chain import FOOT_PARAMETERS
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.numbers_that_ran import (
    Ran,
    end_numbers,
    model_numbers,
    parameter_numbers,
    search_numbers,
    size_numbers,
)
from geocontact.standing_up.phase import PhaseProblem, judged
from geocontact.standing_up.phases import TRACKS_C, phase_c
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import ContactParameter, StrapSite, searched
from geocontact.standing_up.trials import StandingTrial, seen_in

ALL, MEAN = "all given", "mean of the calibration"
TOLERANCE = 1e-7
GIVEN: dict[str, tuple[str, ...]] = {
    ALL: TRACKS_C,
    "without ground reaction": ("torque",),
    "without torques": ("force", "centre"),
}
"""Channels by what the predictor is called."""


@dataclass(frozen=True, eq=False)
class HeldOutTrials:
    """Trials to predict.

    Parameters
    ----------
    p
        What is searched of all parameters.
    known
        Trials of the calibration, which say where straps are.
    """

    trials: StandingUpTrials
    p: Float[np.ndarray, " p"]
    known: StandingUpTrials

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters by name, in SI."""
        every = _parameters(self.known.sites)
        return {each.name: each.value(float(p)) for each, p in zip(every, self.p, strict=True)}


def _parameters(sites: Sequence[StrapSite]) -> tuple[ContactParameter, ...]:
    return (*FOOT_PARAMETERS, *(each for site in sites for each in site.parameters))


def read(o: StandingPredictOptions) -> HeldOutTrials:
    """Everything the options name; InputError where trials are not of one model."""
    trials = standing_trials(o.study, "study", o.c3d_unit)
    known = standing_trials(o.against, "`against`", o.c3d_unit)
    for file, study in ((o.study, trials), (o.against, known)):
        if not study.exoskeleton or not {"force", "centre", "torque", "strap"} <= set(study.tracks):
            what = "is not of a person with an exoskeleton, with force, centre, torque and strap"
            raise InputError(file, "", what, "write exoskeleton = true, and name torques and strap of each trial")
    if trials.subject != known.subject:
        raise InputError(o.study, "mass", "is another person's than the calibration's", "predict trials of one person")
    lacking = {site.name for site in trials.sites} - {site.name for site in known.sites}
    if lacking:
        what = f"has a strap at the {min(lacking)}, which the calibration has not"
        raise InputError(o.study, "", what, f"leave strap_{min(lacking)} out, or calibrate with it")
    every = _parameters(known.sites)
    bounds = {each.name: (each.least, each.most) for each in every}
    values = read_contact_parameters(o.parameters, {each.name: each.unit for each in every}, bounds)
    add_input("`parameters`", o.parameters, parameters=len(values))
    return HeldOutTrials(trials, searched(every, [values[each.name] for each in every]), known)


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
        seen = self.trial.judged.certificate
        return seen is not None and seen.converged


def trials_begun(predictions: Sequence[PredictedTrial]) -> tuple[StandingTrial, ...]:
    """Recordings of the trials that are predicted, each once."""
    return tuple({one.trial.recorded.name: one.trial.recorded for one in predictions}.values())


Keep = Callable[[Sequence[PredictedTrial]], None]
"""Told of all predictions that there are, as soon as a trial is done."""


@dataclass
class _Asked:
    """Whether Ctrl-C was pressed, also between two searches."""

    stop: bool = False


def predicted(given: HeldOutTrials, o: StandingPredictOptions, keep: Keep) -> tuple[PredictedTrial, ...]:
    """Trials outer, predictors inner; searches without an answer and motions without a certificate are warned of.

    Ctrl-C ends the search that is going on, keeps its last iterate and begins no other.
    """
    model, predictions = (
        strapped(given.trials.subject, given.known.sites, seated=given.trials.seated),
        list[PredictedTrial](),
    )
    trials, asked = given.trials.trials, _Asked()
    with listener().stages("predicting") as stage, stopped_by_ctrl_c(asked):
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
    _doubt(predictions, len(trials))
    return tuple(predictions)


def _at(stage: Callable[[str], None], where: str, told: str) -> None:
    stage(f"{where}, {told}")


def complete(predictions: Sequence[PredictedTrial], trials: int) -> bool:
    """Whether so many trials are predicted by every predictor, and every motion is certified."""
    return len(predictions) == trials * len(GIVEN) and all(one.certified for one in predictions)


def _doubt(predictions: Sequence[PredictedTrial], trials: int) -> None:
    for one in predictions:
        place = f"{one.trial.recorded.name} {one.name}"
        if not one.solved:
            reserve(f"{place} ended without an answer: {one.ending}; it is its last iterate")
        elif one.trial.judged.certificate is not None and not one.trial.judged.certificate.converged:
            reserve(not_certified(place, one.trial.judged.certificate))
    if len(predictions) < trials * len(GIVEN):
        last, ended = predictions[-1], [one for one in predictions if not one.ending.startswith(INTERRUPTED)]
        where = f"the last search was {last.trial.recorded.name} {last.name}"
        reserve(f"interrupted: {len(ended) // len(GIVEN)} of {trials} trials have every predictor; {where}")


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


def prediction_numbers(predictions: Sequence[PredictedTrial]) -> list[Ran]:
    """Model, parameters and cost once, which all predictors share; the mesh of each motion."""
    first = predictions[0]
    rows = model_numbers(first.model) + parameter_numbers(first.phase.parameters, first.p, note=FROM_FILE)
    rows += size_numbers(sizes_of(first.phase)) + end_numbers(first.phase.control)
    for one in predictions:
        rows += search_numbers([one.motion], [one.trial.recorded], f"{one.name} ")
    return rows


def predicted_meshes(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """Ends of the intervals of every motion."""
    return mesh_table("predictor", [(one.name, [one.motion]) for one in predictions])


def certificates_table(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """What lies between and beyond the points of every motion."""
    rows = []
    for one in predictions:
        rows += certificate_rows(one.name, [one.trial.recorded.name], [one.trial.judged])
    return pd.DataFrame(rows).rename(columns={"phase": "predictor"})
