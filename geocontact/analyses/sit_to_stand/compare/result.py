"""Predictions beside recordings: `geocontact sit-to-stand compare`, `gc.sit_to_stand.compare`.

>>> import geocontact as gc
>>> held_out, planted = "meshes/standing_up_held_out/study.toml", "meshes/standing_up_exoskeleton/truth.csv"
>>> given = {"parameters": planted, "against": "meshes/standing_up_exoskeleton/study.toml", "nodes": 5}
>>> gc.sit_to_stand.compare(held_out, **given).sentences[0]
'the prediction is nearer than both baselines on … of 10 channels that are not given'
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from geocontact.analyses.frame.collector import contradicted, if_it_fits, judge, note, results_place, say
from geocontact.analyses.frame.folder import written_whole
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.main_numbers import by_name
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.analyses.sit_to_stand.compare.show import compared_curves, compared_page
from geocontact.analyses.sit_to_stand.goodness import goodness_of_predictions
from geocontact.analyses.sit_to_stand.predict.predictions import (
    MEAN,
    HeldOutTrials,
    certificates_table,
    complete,
    predicted,
    predicted_meshes,
    read,
    say_unplaced,
    trials_begun,
)
from geocontact.analyses.sit_to_stand.trial_tables import channels, ran_table
from geocontact.identify.signals.agreement import agreement
from geocontact.io.text.results import write_table
from geocontact.standing_up.prediction import ALL, PredictedTrial, prediction_numbers
from geocontact.standing_up.trials import StandingTrial
from geocontact.standing_up.trivial_trials import mean_trial, nearest_trial
from geocontact.view.page.content import Page

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet

NEAREST = "nearest of the calibration"
BASELINES = (MEAN, NEAREST)
"""Predictors without a model."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingCompareResult(Result):
    """Predictions beside recordings.

    Parameters
    ----------
    predictions
        Trials outer, predictors inner.
    trivial
        Predictors without a model, by trial and name.
    errors
        One row for each trial, predictor and channel.
    """

    claims: ClassVar[frozenset[str]] = frozenset(("certified",))

    options: StandingCompareOptions
    given: HeldOutTrials
    predictions: tuple[PredictedTrial, ...]
    trivial: Mapping[str, Mapping[str, StandingTrial]]
    errors: pd.DataFrame

    @property
    def accepted(self) -> bool:
        """Whether every trial is predicted, and every motion certified."""
        return complete(self.predictions, self.given)

    @property
    def rmsd(self) -> dict[tuple[str, str, str], float]:
        """Root mean square difference by trial, predictor and quantity: angles [rad], forces [N]."""
        return by_name(self.errors, ("trial", "predictor", "quantity"), "rmsd")

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison`, `certificate`, `numbers` and `mesh`."""
        return {
            "comparison": self.errors,
            "certificate": certificates_table(self.predictions),
            "numbers": ran_table(prediction_numbers(self.predictions)),
            "mesh": predicted_meshes(self.predictions),
        }

    def curves(self) -> dict[str, CurveSheet]:
        """`comparison`: angles and strap of the first trial."""
        first = self.given.trials.trials[0]
        own = {one.name: one.trial.model for one in self.predictions if one.trial.recorded.name == first.name}
        return {"comparison": compared_curves(first, {ALL: own[ALL], **self.trivial[first.name]})}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving chains, curves, errors by predictor."""
        best = [one.trial for one in self.predictions if one.name == ALL]
        subject, predicted = self.given.trials.subject, self.curves()["comparison"]
        tiles = compared_tiles(self.errors) if self.fits else []
        return {REPORT: compared_page(self.sentences, tiles, subject, best, predicted, self.tables())}


def run(given: HeldOutTrials, o: StandingCompareOptions) -> StandingCompareResult:
    """Predictions of phase C with all or parts of what is given, and two predictors without a model."""

    def keep(predictions: Sequence[PredictedTrial]) -> None:
        place = results_place()
        if place is not None:
            with written_whole(place) as draft:
                write_table(_compared(given, predictions, _trivial(given, predictions)), draft, "comparison")

    predictions = predicted(given, o, keep)
    trivial = _trivial(given, predictions)
    errors = _compared(given, predictions, trivial)
    result = StandingCompareResult(options=o, given=given, predictions=predictions, trivial=trivial, errors=errors)
    judge(goodness_of_predictions(predictions, given.trials.noise))
    _report(result)
    for trial in trials_begun(predictions):
        near = nearest_trial(given.known.trials, trial)
        say(f"{trial.name}: nearest by its first and last posture is {near.name}")
    return result


def _trivial(given: HeldOutTrials, predictions: Sequence[PredictedTrial]) -> dict[str, dict[str, StandingTrial]]:
    """Predictors without a model, by trial and name."""
    known, found = given.known.trials, {}
    for trial in trials_begun(predictions):
        near = nearest_trial(known, trial)
        found[trial.name] = {MEAN: mean_trial(known, trial.time), NEAREST: mean_trial([near], trial.time)}
    return found


def _compared(
    given: HeldOutTrials,
    predictions: Sequence[PredictedTrial],
    trivial: Mapping[str, Mapping[str, StandingTrial]],
) -> pd.DataFrame:
    """One row for each trial, predictor and channel."""
    rows: list[dict[str, object]] = []
    for trial in trials_begun(predictions):
        models = {one.name: one.trial.model for one in predictions if one.trial.recorded.name == trial.name}
        for predictor, model in {**models, **trivial[trial.name]}.items():
            rows += _rows(trial, model, predictor, given)
    return pd.DataFrame(rows)


def _rows(
    trial: StandingTrial, model: StandingTrial, predictor: str, given: HeldOutTrials
) -> Iterator[dict[str, object]]:
    step = 1.0 / trial.rate
    tracks = next((one.tracks for one in given.predictors if one.name == predictor), ())
    for each in channels(trial, model, given.trials.noise):
        if each.channel != "rates":
            a = agreement(each.model, each.recorded, step, 0.0)
            off = {name: each.factor * getattr(a, name) for name in ("mae", "rmsd", "bias")}
            told = {"trial": trial.name, "predictor": predictor, "quantity": each.name, "unit": each.unit}
            known = each.channel in tracks
            yield {**told, "given": "yes" if known else "no", **off, "r2 [-]": a.r2, "noise": each.factor * each.noise}


def _report(r: StandingCompareResult) -> None:
    errors = r.errors
    if not contradicted():
        won, channels_free = nearer_than_both(errors)
        say(f"the prediction is nearer than both baselines on {won} of {channels_free} channels that are not given")
        note("better than both", [won, channels_free])
    for quantity in ("strap", "knee"):
        own = errors[errors["quantity"] == quantity]
        each = own.groupby("predictor", sort=False)["rmsd"].max()
        unit = str(own["unit"].iloc[0]).replace("deg", "°")
        words = ", ".join(f"{name} {value:.3g} {unit}" for name, value in each.items())
        verdict = if_it_fits(f"; {_verdict(each)}")
        say(f"{quantity}, largest RMSD of {counted(len(r.trivial), 'trial')}: {words}{verdict}")
        note(quantity, {str(name): float(value) for name, value in each.items()})
    say_unplaced(r.given)


def nearer_than_both(errors: pd.DataFrame) -> tuple[int, int]:
    """Channels that are not given and on which the prediction is nearer than both baselines, of how many; one that
    the calibration's trials do not have has no baseline and does not count.
    """
    best = errors[errors["predictor"] == ALL].set_index(["trial", "quantity"])["rmsd"]
    others = errors[errors["predictor"].isin(BASELINES)].groupby(["trial", "quantity"])["rmsd"].min()
    others = others.dropna()
    free = errors[(errors["predictor"] == ALL) & (errors["given"] == "no")].set_index(["trial", "quantity"]).index
    free = free.intersection(others.index)
    return int((best[free] < others[free]).sum()), len(free)


def _verdict(rmsd: pd.Series) -> str:
    """Whether the prediction is nearer than both baselines, by RMSD of each predictor."""
    nearer = [name for name in BASELINES if rmsd[name] <= rmsd[ALL]]
    return (
        f"nearer than the prediction: {', '.join(nearer)}" if nearer else "the prediction is nearer than both baselines"
    )


def compared_tiles(errors: pd.DataFrame) -> list[tuple[str, str]]:
    """Channels won, and the largest RMSD of strap and knee beside that of the better baseline."""
    won, free = nearer_than_both(errors)
    found = [("channels nearer than both baselines", f"{won} of {free}")]
    for quantity in ("strap", "knee"):
        own = errors[errors["quantity"] == quantity]
        each = own.groupby("predictor", sort=False)["rmsd"].max()
        unit = str(own["unit"].iloc[0]).replace("deg", "°")
        least = min(each[name] for name in BASELINES)
        found.append((f"{quantity}, RMSD (better baseline)", f"{each[ALL]:.3g} {unit} ({least:.3g} {unit})"))
    return found


compare = Job("sit-to-stand compare", StandingCompareOptions, read, run)
