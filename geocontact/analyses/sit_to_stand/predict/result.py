"""Motion and strap force of held-out trials: `geocontact sit-to-stand predict`, `gc.sit_to_stand.predict`.

>>> import geocontact as gc
>>> held_out, planted = "meshes/standing_up_held_out/study.toml", "meshes/standing_up_exoskeleton/truth.csv"
>>> given = {"parameters": planted, "against": "meshes/standing_up_exoskeleton/study.toml", "nodes": 5}
>>> gc.sit_to_stand.predict(held_out, **given).sentences[0]
"1 trial predicted: strap within … N, the person's angles within …° (largest RMSD)"
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import contradicted, judge, note, results_place, say
from geocontact.analyses.frame.folder import written_whole
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.main_numbers import by_name
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.analyses.sit_to_stand.exports import write_motion
from geocontact.analyses.sit_to_stand.goodness import goodness_of_predictions
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.predictions import (
    MEAN,
    HeldOutTrials,
    certificates_table,
    complete,
    predicted,
    predicted_meshes,
    read,
    say_unplaced,
    shown_alike,
    trials_begun,
)
from geocontact.analyses.sit_to_stand.rmsd_by_trial import rmsd_by_trial
from geocontact.analyses.sit_to_stand.show import PARTS, motion_page, over_parts, standing_curves, standing_scene
from geocontact.analyses.sit_to_stand.study_figures import KINEMATICS, STRAPS, study_figure
from geocontact.analyses.sit_to_stand.trial_tables import (
    DEGREE,
    errors_table,
    ran_table,
    trial_table,
)
from geocontact.io.text.results import write_table
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.prediction import ALL, PredictedTrial, prediction_numbers
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial
from geocontact.standing_up.trivial_trials import mean_trial
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, stroke
from geocontact.view.page.content import Page, Section
from geocontact.view.page.tables import frame_table

MODEL = [
    "Ground reaction, centre of pressure and torques are given over time, first and last posture within their noise.",
    "Coordinates between them and the strap's force are predicted; parameters are held.",
    "Without ground reaction, without torques: the same with less given.",
    "Mean of the calibration: coordinates and strap of its trials over parts of the movement.",
    "Both legs are one planar chain: torques and the ground's force are for both, a strap's force for one.",
]
COMPARED = ("coordinates", "force", "centre", "torque", "strap")


def strap_curves(predictions: Sequence[tuple[str, TrialResult]], means: Mapping[str, StandingTrial]) -> CurveSheet:
    """The strap's force in each trial: as recorded, by each predictor, and by the mean of other trials."""
    panels = []
    for name, mean in means.items():
        own = [(who, trial) for who, trial in predictions if trial.recorded.name == name]
        seen = own[0][1].recorded
        forces = {"recorded": (seen.strap, INK)}
        forces |= {who: (trial.model.strap, stroke(k, k)) for k, (who, trial) in enumerate(own)}
        forces["mean of the calibration"] = (mean.strap, stroke(4, 2))
        curves = [
            Curve(who, over_parts(seen.time, force), stroke=look)
            for who, (force, look) in forces.items()
            if force is not None
        ]
        panels.append(Curves(f"Normal force of one strap in {name}", "N", curves))
    return CurveSheet(panels, PARTS)


def prediction_page(
    sentences: Sequence[str],
    given: HeldOutTrials,
    trials: Sequence[TrialResult],
    straps: CurveSheet,
    tables: Mapping[str, pd.DataFrame],
) -> Page:
    """Moving chains with forces, curves, errors by predictor; `straps` are those of `strap_curves`."""
    sections: list[Section] = [
        standing_scene(given.trials.subject, trials),
        *standing_curves(trials),
        *straps.panels,
        frame_table("Root mean square differences", tables["errors"], 3),
        frame_table("The same by trial: mean and SD over joints, and SD over trials", tables["rmsd_by_trial"], 3),
        frame_table("Between and beyond the collocation points", tables["certificate"], 3),
    ]
    titles = (
        "Standing up, predicted",
        f"{', '.join(t.recorded.name for t in trials)}; contacts calibrated on other trials",
    )
    return motion_page(titles, sentences, sections, MODEL)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingPredictResult(Result):
    """Predicted motions.

    Parameters
    ----------
    predictions
        Trials outer, predictors inner.
    means
        The trivial predictor, by trial.
    """

    claims: ClassVar[frozenset[str]] = frozenset(("certified",))

    options: StandingPredictOptions
    given: HeldOutTrials
    predictions: tuple[PredictedTrial, ...]
    means: Mapping[str, StandingTrial]

    @property
    def best(self) -> tuple[TrialResult, ...]:
        """Trials by the predictor that is given everything."""
        return tuple(one.trial for one in self.predictions if one.name == ALL)

    @property
    def accepted(self) -> bool:
        """Whether every trial is predicted, and every motion certified."""
        return complete(self.predictions, self.given)

    @property
    def errors(self) -> pd.DataFrame:
        """Root mean square difference of each channel by each predictor."""
        parts = []
        for one in self.predictions:
            rows = errors_table([one.trial], self.given.trials.noise, COMPARED)
            parts.append(rows.assign(predictor=one.name))
        parts.append(pd.DataFrame([row for trial in self.best for row in self._by_the_mean(trial)]))
        columns = ["trial", "predictor", "quantity", "unit", "rmsd", "noise"]
        return pd.concat(parts, ignore_index=True)[columns]

    def _by_the_mean(self, trial: TrialResult) -> list[dict[str, object]]:
        seen, mean, noise = trial.recorded, self.means[trial.recorded.name], self.given.trials.noise
        columns = [
            (name, "deg", DEGREE, mean.q[:, k] - seen.q[:, k], noise.angle)
            for k, name in enumerate((*COORDINATES, *EXO_JOINTS))
            if k > 1
        ]
        if seen.strap is not None and mean.strap is not None:
            columns.append(("strap", "N", 1.0, mean.strap - seen.strap, noise.strap))
        columns += [
            (f"{site} strap", "N", 1.0, mean.elsewhere[site] - force, noise.strap)
            for site, force in seen.elsewhere.items()
            if site in mean.elsewhere
        ]
        return [
            {
                "trial": seen.name,
                "predictor": MEAN,
                "quantity": name,
                "unit": unit,
                "rmsd": factor * float(np.sqrt(np.mean(off**2))),
                "noise": factor * size,
            }
            for name, unit, factor, off, size in columns
            if np.isfinite(off).all()
        ]

    @property
    def rmsd(self) -> dict[tuple[str, str, str], float]:
        """Root mean square difference by trial, predictor and quantity: angles [rad], forces [N]."""
        return by_name(self.errors, ("trial", "predictor", "quantity"), "rmsd")

    def tables(self) -> dict[str, pd.DataFrame]:
        """`errors`, `rmsd_by_trial`, `certificate`, `numbers`, `mesh`; `trial_NAME` by what is given everything."""
        own = {
            f"trial_{trial.recorded.name}": trial_table(trial, self.given.trials.noise, COMPARED) for trial in self.best
        }
        ran = {"numbers": ran_table(prediction_numbers(self.predictions)), "mesh": predicted_meshes(self.predictions)}
        found = {"errors": self.errors, "rmsd_by_trial": self.by_trial}
        return {**found, "certificate": certificates_table(self.predictions), **ran, **own}

    @property
    def by_trial(self) -> pd.DataFrame:
        """Root mean square differences by variable and trial, as in Table III of the study."""
        groups: dict[str, list[TrialResult]] = {}
        for one in self.predictions:
            groups.setdefault(one.name, []).append(one.trial)
        return rmsd_by_trial("predictor", groups, self.given.trials.trials, self.given.trials.noise)

    def curves(self) -> dict[str, CurveSheet]:
        """`strap`: its force by all predictors; `kinematics`, `straps`: figures 6 and 7 of the study."""
        shown = {f"{one.trial.recorded.name} {one.name}": one.trial for one in shown_alike(self.predictions)}
        noise = self.given.trials.noise
        return {
            "strap": strap_curves([(one.name, one.trial) for one in self.predictions], self.means),
            "kinematics": study_figure(KINEMATICS, shown, noise),
            "straps": study_figure(STRAPS, shown, noise),
        }

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving chains with forces, curves, errors by predictor."""
        return {REPORT: prediction_page(self.sentences, self.given, self.best, self.curves()["strap"], self.tables())}

    def write_files(self, folder: Path) -> None:
        """Trajectories; tables, figure, page."""
        self._write_motions(folder)
        super().write_files(folder)

    def write_numbers(self, folder: Path) -> None:
        """Tables and trajectories of the trials that there are."""
        for name, rows in self.tables().items():
            write_table(rows, folder, name)
        self._write_motions(folder)

    def _write_motions(self, folder: Path) -> None:
        subject = self.given.trials.subject
        for one in self.predictions:
            if one.name == ALL:
                write_motion(folder, subject, one.trial, self.given.values, one.solved, self.given.known.sites)


def run(given: HeldOutTrials, o: StandingPredictOptions) -> StandingPredictResult:
    """Every trial by every predictor; tables and motions of a trial are written as soon as it is done."""

    def result_of(predictions: Sequence[PredictedTrial]) -> StandingPredictResult:
        means = {t.name: mean_trial(given.known.trials, t.time) for t in trials_begun(predictions)}
        return StandingPredictResult(options=o, given=given, predictions=tuple(predictions), means=means)

    def keep(predictions: Sequence[PredictedTrial]) -> None:
        place = results_place()
        if place is not None:
            with written_whole(place) as draft:
                result_of(predictions).write_numbers(draft)

    result = result_of(predicted(given, o, keep))
    judge(goodness_of_predictions(result.predictions, given.trials.noise))
    _report(result)
    return result


def _report(r: StandingPredictResult) -> None:
    errors = r.errors
    strap = errors[errors["quantity"].str.endswith("strap")].groupby("predictor", sort=False)["rmsd"].max()
    turning = errors["quantity"].isin(COORDINATES) & (errors["unit"] == "deg")
    angles = errors[turning].groupby("predictor", sort=False)["rmsd"].max()
    say(
        f"{counted(len(r.means), 'trial')} predicted: strap within {strap[ALL]:.1f} N, the person's "
        f"angles within {angles[ALL]:.2f}° (largest RMSD)"
    )
    others = [f"{name} {strap[name]:.1f} N and {angles[name]:.2f}°" for name in strap.index if name != ALL]
    say(f"for comparison: {'; '.join(others)}")
    say_unplaced(r.given)
    seen = [one.trial.judged.certificate for one in r.predictions]
    passed = sum(each is not None and each.converged for each in seen)
    if not contradicted():
        say(f"{passed} of {counted(len(seen), 'motion')} certified")
    note(
        "predict",
        {
            "strap_rmsd_N": {str(name): float(value) for name, value in strap.items()},
            "person_angle_rmsd_deg": {str(name): float(value) for name, value in angles.items()},
            "cpu_seconds": [round(one.seconds, 3) for one in r.predictions],
            "iterations": [one.iterations for one in r.predictions],
        },
    )


predict = Job("sit-to-stand predict", StandingPredictOptions, read, run)
