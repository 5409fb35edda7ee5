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
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.analyses.sit_to_stand.trial_tables import certificate_rows, mesh_table, not_certified
from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.solve import SolverOptions, stopped_by_ctrl_c
from geocontact.io.recordings.spheres import read_contact_parameters
from geocontact.standing_up.calibrated_phase import INTERRUPTED
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.prediction import GIVEN, PredictedTrial, contact_parameters, predicted_trial
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import searched
from geocontact.standing_up.trials import StandingTrial, StandingUpTrials

MEAN = "mean of the calibration"
TOLERANCE = 1e-7


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
        every = contact_parameters(self.known.sites)
        return {each.name: each.value(float(p)) for each, p in zip(every, self.p, strict=True)}


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
        what = f"has a strap at the {min(lacking)}, which the calibration does not have"
        raise InputError(o.study, "", what, f"leave strap_{min(lacking)} out, or calibrate with it")
    every = contact_parameters(known.sites)
    bounds = {each.name: (each.least, each.most) for each in every}
    values = read_contact_parameters(o.parameters, {each.name: each.unit for each in every}, bounds)
    add_input("`parameters`", o.parameters, parameters=len(values))
    return HeldOutTrials(trials, searched(every, [values[each.name] for each in every]), known)


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
            reserve(f"{place} did not converge: {one.ending}; this is its last iterate")
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
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)

    def tell(iteration: int, objective: float, residual: float) -> None:
        stage(f"iteration {iteration}, objective {objective:.5g}, residual {residual:.2g}")

    name, tracks = predictor
    known = name, model, given.trials.subject, trial, given.trials.noise, given.p
    return predicted_trial(*known, options, nodes=o.nodes, tracks=tracks, progress=tell)


def predicted_meshes(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """Ends of the intervals of every motion."""
    return mesh_table("predictor", [(one.name, [one.motion]) for one in predictions])


def certificates_table(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """What lies between and beyond the points of every motion."""
    rows = []
    for one in predictions:
        rows += certificate_rows(one.name, [one.trial.recorded.name], [one.trial.judged])
    return pd.DataFrame(rows).rename(columns={"phase": "predictor"})
