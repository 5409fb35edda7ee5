"""Held-out trials predicted, with parts of what is given left out, and by the mean of other trials."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.predict.result import ALL, PredictedTrial, StandingPredictResult
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.judged import judged
from geocontact.standing_up.phase_c import TRACKS_C, phase_c
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingTrial, seen_in
from geocontact.standing_up.trivial_trials import mean_trial

TOLERANCE = 1e-7
GIVEN: dict[str, tuple[str, ...]] = {
    ALL: TRACKS_C,
    "without ground reaction": ("torque",),
    "without torques": ("force", "centre"),
}
"""Channels by what the predictor is called."""


def run(given: HeldOutTrials, o: StandingPredictOptions, record: Record) -> StandingPredictResult:
    """Every trial by every predictor."""
    predictions = predicted(given, o, record)
    means = {trial.name: mean_trial(given.known.trials, trial.time) for trial in given.trials.trials}
    result = StandingPredictResult(record=record, options=o, given=given, predictions=predictions, means=means)
    _say(result)
    return result


def predicted(given: HeldOutTrials, o: StandingPredictOptions, record: Record) -> tuple[PredictedTrial, ...]:
    """Trials outer, predictors inner; searches without an answer and motions without a certificate are warned of."""
    model, predictions = strapped(given.trials.subject, given.known.sites, seated=given.trials.seated), []
    with record.listener.stages("predicting") as stage:
        for trial in given.trials.trials:
            for name, tracks in GIVEN.items():
                predictions.append(_predicted(model, given, trial, (name, tracks), o, stage))
    for one in predictions:
        place = f"{one.trial.recorded.name} {one.name}"
        if not one.solved:
            record.warn(f"{place} ended without an answer: {one.ending}; it is its last iterate")
        elif one.trial.judged.certificate is not None and not one.trial.judged.certificate.converged:
            failed = "; ".join(one.trial.judged.certificate.failed)
            record.warn(f"{place} is not certified: {failed}; give more `nodes`")
    return tuple(predictions)


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
        where = f"{trial.name} {name}, iteration {iteration}"
        stage(f"{where}, objective {objective:.5g}, residual {residual:.2g}")

    mesh = np.linspace(0.0, 1.0, round(o.nodes * float(trial.time[-1])) + 1)
    found = solve(phase.control, options, meshes=(mesh,), progress=told)
    motion, n = found.motions[0], model.count
    (seen,) = judged(model.equations, range(n - 3), model.turning, phase, found, certify=found.solved)
    result = TrialResult(
        recorded=trial,
        model=seen_in(model, motion, found.p, trial.time, trial.name),
        acceleration=motion.state(trial.time)[:, 2 * n : 3 * n],
        judged=seen,
    )
    return PredictedTrial(name, result, found.solved, found.ending, found.iterations, found.seconds)


def _say(r: StandingPredictResult) -> None:
    record, errors = r.record, r.errors
    strap = errors[errors["quantity"].str.endswith("strap")].groupby("predictor", sort=False)["rmsd"].max()
    turning = errors["quantity"].isin(COORDINATES) & (errors["unit"] == "deg")
    angles = errors[turning].groupby("predictor", sort=False)["rmsd"].max()
    record.say(
        f"{counted(len(r.given.trials.trials), 'trial')} predicted: strap within {strap[ALL]:.1f} N, the person's "
        f"angles within {angles[ALL]:.2f}° (largest RMSD)"
    )
    others = [f"{name} {strap[name]:.1f} N and {angles[name]:.2f}°" for name in strap.index if name != ALL]
    record.say(f"beside it: {'; '.join(others)}")
    seen = [one.trial.judged.certificate for one in r.predictions]
    passed = sum(each is not None and each.converged for each in seen)
    record.say(f"{passed} of {counted(len(seen), 'motion')} certified")
    record.results["predict"] = {
        "strap_rmsd_N": {str(name): float(value) for name, value in strap.items()},
        "person_angle_rmsd_deg": {str(name): float(value) for name, value in angles.items()},
        "cpu_seconds": [round(one.seconds, 3) for one in r.predictions],
        "iterations": [one.iterations for one in r.predictions],
    }
