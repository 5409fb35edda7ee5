"""Tables of a calibration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.sit_to_stand.trial_result import TrialResult, channels
from geocontact.standing_up.calibrated_phase import CalibratedPhase
from geocontact.standing_up.contact_numbers import ContactNumber
from geocontact.standing_up.feet import FOOT_PARAMETERS
from geocontact.standing_up.trials import StandingNoise


def parameters_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Value and interval in SI, and standard deviations of what is searched: lengths in m, others as logarithms."""
    rows = [
        {
            "phase": phase.name,
            "parameter": n.name,
            "unit": n.unit,
            "value": n.value,
            "lower": n.lower,
            "upper": n.upper,
            "sd believed": n.before,
            "sd with the trials": n.after if np.isfinite(n.after) else np.nan,
            "verdict": n.verdict,
        }
        for phase in phases
        for n in _own(phase)
    ]
    return pd.DataFrame(rows)


def _own(phase: CalibratedPhase) -> list[ContactNumber]:
    """Of the feet in phase A, of the strap in phase B."""
    feet = {each.name for each in FOOT_PARAMETERS}
    return [n for n in phase.numbers.numbers if (n.name in feet) == (phase.name == "A")]


def correlation_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Of the estimates of the parameters that were sought, phase by phase."""
    parts = []
    for phase in phases:
        n = phase.numbers
        columns = {name: n.correlation[:, k] for k, name in enumerate(n.names)}
        parts.append(pd.DataFrame({"phase": phase.name, "parameter": list(n.names), **columns}))
    return pd.concat(parts, ignore_index=True)


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
        for each in channels(trial, noise)
        if each.channel in tracks
    ]
    return pd.DataFrame(rows, columns=["trial", "quantity", "unit", "rmsd", "noise"])


def certificate_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """What lies between and beyond the points of each motion; empty cells where nothing was certified."""
    rows = []
    for phase, motion, seen in ((p, *each) for p in phases for each in zip(p.found.motions, p.motions, strict=True)):
        c = seen.certificate
        told: dict[str, object] = {"phase": phase.name, "trial": motion.name}
        told["certified"] = "no" if c is None or not c.converged else "yes"
        told |= {"residual [N]": float(seen.force.max()), "residual [N m]": float(seen.moment.max())}
        none = c is None
        told |= {
            "after an interval [-]": np.nan if none else c.interval,
            "after 0.2 s [-]": np.nan if none else c.window,
            "open loop [-]": np.nan if none else c.open_loop,
            "open loop expected [-]": np.nan if none else c.expected,
            "growth rate [1/s]": np.nan if none else c.growth_rate,
        }
        rows.append(told)
    return pd.DataFrame(rows)


def trial_table(trial: TrialResult, noise: StandingNoise, tracks: Sequence[str]) -> pd.DataFrame:
    """Over time: channels as recorded and by the model, torques of both legs, residual."""
    columns = {"time [s]": trial.recorded.time}
    for each in channels(trial, noise):
        if each.channel == "rates":
            continue
        columns[f"{each.name} [{each.unit}]"] = each.factor * each.model
        if each.channel in tracks:
            columns[f"recorded {each.name} [{each.unit}]"] = each.factor * each.recorded
    columns["residual [N]"] = trial.residual(trial.judged.force)
    columns["residual [N m]"] = trial.residual(trial.judged.moment)
    return pd.DataFrame(columns)
