"""Held-out trials predicted, with parts of what is given left out, and by the mean of other trials."""

from __future__ import annotations

from collections.abc import Sequence

from geocontact.analyses.page_words import counted
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.predicted_trial import ALL, PredictedTrial, trials_begun
from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.predict.result import StandingPredictResult
from geocontact.analyses.sit_to_stand.predict.searches import predicted
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.trivial_trials import mean_trial


def run(given: HeldOutTrials, o: StandingPredictOptions, record: Record) -> StandingPredictResult:
    """Every trial by every predictor; tables and motions of a trial are written as soon as it is done."""

    def result_of(predictions: Sequence[PredictedTrial]) -> StandingPredictResult:
        means = {t.name: mean_trial(given.known.trials, t.time) for t in trials_begun(predictions)}
        return StandingPredictResult(record=record, options=o, given=given, predictions=tuple(predictions), means=means)

    def keep(predictions: Sequence[PredictedTrial]) -> None:
        if record.out is not None:
            with written_whole(record.out) as draft:
                result_of(predictions).write_numbers(draft)

    result = result_of(predicted(given, o, record, keep))
    _say(result)
    return result


def _say(r: StandingPredictResult) -> None:
    record, errors = r.record, r.errors
    strap = errors[errors["quantity"].str.endswith("strap")].groupby("predictor", sort=False)["rmsd"].max()
    turning = errors["quantity"].isin(COORDINATES) & (errors["unit"] == "deg")
    angles = errors[turning].groupby("predictor", sort=False)["rmsd"].max()
    record.say(
        f"{counted(len(r.means), 'trial')} predicted: strap within {strap[ALL]:.1f} N, the person's "
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
