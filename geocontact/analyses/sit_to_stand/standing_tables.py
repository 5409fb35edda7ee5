"""Tables of motions that stand up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.sit_to_stand.trial_result import TrialResult, channels
from geocontact.standing_up.judged import JudgedMotion
from geocontact.standing_up.trials import StandingNoise

BEYOND = (
    "after an interval [-]",
    "after 0.2 s [-]",
    "open loop [-]",
    "open loop expected [-]",
    "growth rate [1/s]",
    "intervals [-]",
    "shortest interval [s]",
)
"""Departures of coordinates from another integrator [rad, m], the growth of deviations, and the mesh."""


def errors_table(trials: Sequence[TrialResult], noise: StandingNoise, tracks: Sequence[str]) -> pd.DataFrame:
    """Root mean square difference of each channel, with the noise that it was said to have beside it."""
    rows = [
        {
            "trial": trial.recorded.name,
            "quantity": each.name,
            "unit": each.unit,
            "rmsd": each.factor * float(np.sqrt(np.mean((each.model - each.recorded) ** 2))),
            "noise": each.factor * each.noise,
        }
        for trial in trials
        for each in channels(trial.recorded, trial.model, noise)
        if each.channel in tracks and np.isfinite(each.recorded).all()
    ]
    return pd.DataFrame(rows, columns=["trial", "quantity", "unit", "rmsd", "noise"])


def certificate_rows(phase: str, names: Sequence[str], motions: Sequence[JudgedMotion]) -> list[dict[str, object]]:
    """What lies between and beyond the points of each motion; empty cells where nothing was certified."""
    rows = []
    for name, seen in zip(names, motions, strict=True):
        c = seen.certificate
        told: dict[str, object] = {"phase": phase, "trial": name}
        told["certified"] = "no" if c is None or not c.converged else "yes"
        told |= {"residual [N]": float(seen.force.max()), "residual [N m]": float(seen.moment.max())}
        sizes: tuple[float, ...] = (np.nan,) * len(BEYOND)
        if c is not None:
            sizes = c.interval, c.window, c.open_loop, c.expected, c.growth_rate, c.intervals, c.shortest
        rows.append(told | dict(zip(BEYOND, sizes, strict=True)))
    return rows


def trial_table(trial: TrialResult, noise: StandingNoise, tracks: Sequence[str]) -> pd.DataFrame:
    """Over time: channels as recorded and by the model, torques of both legs, residual."""
    columns = {"time [s]": trial.recorded.time}
    for each in channels(trial.recorded, trial.model, noise):
        if each.channel == "rates":
            continue
        columns[f"{each.name} [{each.unit}]"] = each.factor * each.model
        if each.channel in tracks and np.isfinite(each.recorded).all():
            columns[f"recorded {each.name} [{each.unit}]"] = each.factor * each.recorded
    columns["residual [N]"] = trial.residual(trial.judged.force)
    columns["residual [N m]"] = trial.residual(trial.judged.moment)
    return pd.DataFrame(columns)
