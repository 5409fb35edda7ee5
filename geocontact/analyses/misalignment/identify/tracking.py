"""Performance beside the force of an elbow: tracking error by trial, scores from a table, both over the force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.misalignment.law_numbers import MMHG
from geocontact.axis_misalignment.tracking import GoesWith, Tracking, goes_with, of_conditions, tracking_of
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.io.text.side_table import read_side_table

TRIAL = "trial"
RMSE, FORCE, PRESSURE = "tracking rmse [deg]", "rms force [N]", "pressure [mmHg]"


@dataclass(frozen=True, eq=False)
class Performance:
    """Each trial with its condition, its tracking, and its scores.

    Parameters
    ----------
    scores
        A row for each trial in the order of `names`, columns as they are in the table.
    related
        How error and scores go with force and pressure over the trials.
    """

    names: tuple[str, ...]
    conditions: tuple[str, ...]
    trials: tuple[Tracking, ...]
    scores: pd.DataFrame
    related: Sequence[GoesWith]

    def measures(self) -> dict[str, np.ndarray]:
        """Tracking error [deg] and scores by trial; what nobody measured is left out."""
        error = np.degrees([each.rmse for each in self.trials])
        own = {RMSE: error} if np.isfinite(error).any() else {}
        return {**own, **{str(name): self.scores[name].to_numpy(float) for name in self.scores}}


def performance_of(groups: dict[str, Sequence[ElbowRecording]], scores: pd.DataFrame | None) -> Performance | None:
    """Performance of the recordings by condition; None where there is neither a target nor a score."""
    pairs = [(condition, r) for condition, recordings in groups.items() for r in recordings]
    if scores is None and all(r.target is None for _, r in pairs):
        return None
    names = tuple(r.name for _, r in pairs)
    own = pd.DataFrame(index=names) if scores is None else scores.reindex(list(names))
    trials = tuple(tracking_of(r) for _, r in pairs)
    found = Performance(names, tuple(condition for condition, _ in pairs), trials, own, ())
    overs = {FORCE: np.array([each.rms_force for each in trials])}
    overs[PRESSURE] = np.array([each.pressure for each in trials]) / MMHG
    return Performance(names, found.conditions, trials, own, goes_with(found.measures(), overs))


def read_scores(path: Path | None, recordings: Sequence[ElbowRecording]) -> pd.DataFrame | None:
    """Scores by trial; InputError for a trial that is not there, twice there, or a table without scores."""
    if path is None:
        return None
    table = read_side_table(path, (TRIAL,))
    if TRIAL not in table:
        raise InputError(path, "line 1", "no column 'trial'", "name each recording in it, without its ending")
    names = table[TRIAL].astype(str)
    known = {r.name for r in recordings}
    wrong = [name for name in names if name not in known]
    if wrong:
        raise InputError(path, "", f"{wrong[0]!r} is not a recording here", f"these are {', '.join(sorted(known))}")
    if names.duplicated().any():
        raise InputError(path, "", f"{names[names.duplicated()].iloc[0]!r} is there twice", "give each trial one row")
    scores = table.drop(columns=TRIAL).select_dtypes("number").set_axis(names.to_numpy(), axis=0)
    if scores.empty or not len(scores.columns):
        raise InputError(path, "line 1", "no column of numbers", "write a unit: comfort [-]")
    add_input("scores", path, trials=len(scores))
    return scores


def performance_tables(found: Performance) -> dict[str, pd.DataFrame]:
    """`tracking` by trial, `conditions_compared`, and `performance`: what goes with force and pressure."""
    rows = [
        {
            "trial": name,
            "condition": condition,
            RMSE: np.degrees(t.rmse),
            "bias [deg]": np.degrees(t.bias),
            "delay [s]": t.delay,
            "gain [-]": t.gain,
            "rest [deg]": np.degrees(t.rest),
            FORCE: t.rms_force,
            "peak force [N]": t.peak_force,
            PRESSURE: t.pressure / MMHG,
        }
        for name, condition, t in zip(found.names, found.conditions, found.trials, strict=True)
    ]
    tracking = pd.DataFrame(rows).assign(**{str(name): found.scores[name].to_numpy() for name in found.scores})
    force = {FORCE: tracking[FORCE].to_numpy()}
    columns = ["condition", "measure", "trials", "mean", "sd"]
    compared = pd.DataFrame(of_conditions(found.conditions, {**found.measures(), **force}), columns=columns)
    related = pd.DataFrame(
        [(g.measure, g.over, g.trials, g.slope, g.lower, g.upper, g.rank, g.p, g.p_holm) for g in found.related],
        columns=["measure", "over", "trials", "slope", "lower", "upper", "spearman", "p", "p holm"],
    )
    return {"tracking": tracking, "tracking_conditions": compared, "performance": related}


def performance_sentences(found: Performance) -> list[str]:
    """Error by condition, then what goes with the force."""
    told = [
        f"{name}, {condition}: {mean:.3g}{'' if np.isnan(sd) else f' ± {sd:.2g}'} over {count}"
        for condition, name, count, mean, sd in of_conditions(found.conditions, found.measures())
    ]
    told += [
        f"{g.measure} over {g.over}: {g.slope:+.2g} per unit (95 % {g.lower:.2g} … {g.upper:.2g}), "
        f"Spearman {g.rank:+.2f}, p = {g.p_holm:.2g} (Holm)"
        for g in found.related
        if g.over == FORCE
    ]
    return told


def described_performance(found: Performance) -> dict[str, Any]:
    """For elbow.json."""
    tables = performance_tables(found)
    return {
        name: tables[table].astype(object).where(tables[table].notna(), None).to_dict("records")
        for name, table in (("trials", "tracking"), ("over_force", "performance"))
    }
