"""Tables of a calibration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.standing_up.chain import COORDINATES, JOINTS, TURNING
from geocontact.standing_up.contact_numbers import ContactNumbers
from geocontact.standing_up.trials import StandingNoise

DEGREE = float(np.degrees(1.0))
MILLIMETRE = 1e3


def parameters_table(numbers: ContactNumbers) -> pd.DataFrame:
    """Value and interval in SI, and standard deviations of what is searched: lengths in m, others as logarithms."""
    rows = [
        {
            "parameter": n.name,
            "unit": n.unit,
            "value": n.value,
            "lower": n.lower,
            "upper": n.upper,
            "sd believed": n.before,
            "sd with the trials": n.after if np.isfinite(n.after) else np.nan,
            "verdict": n.verdict,
        }
        for n in numbers.numbers
    ]
    return pd.DataFrame(rows)


def correlation_table(numbers: ContactNumbers) -> pd.DataFrame:
    """Of the estimates of the parameters that were sought."""
    columns = {name: numbers.correlation[:, k] for k, name in enumerate(numbers.names)}
    return pd.DataFrame({"parameter": list(numbers.names), **columns})


def errors_table(trials: Sequence[TrialResult], noise: StandingNoise, tracks: Sequence[str]) -> pd.DataFrame:
    """Root mean square difference of each channel, with the noise that it was said to have beside it."""
    rows = []
    for trial in trials:
        seen, model = trial.recorded, trial.model
        columns = []
        for k, (name, turns) in enumerate(zip(COORDINATES, TURNING, strict=True)):
            unit, factor, size = ("deg", DEGREE, noise.angle) if turns else ("mm", MILLIMETRE, noise.length)
            columns.append(("coordinates", name, unit, factor, model.q[:, k] - seen.q[:, k], size))
        for k, (name, turns) in enumerate(zip(COORDINATES, TURNING, strict=True)):
            unit, factor = ("deg/s", DEGREE) if turns else ("mm/s", MILLIMETRE)
            columns.append(("rates", f"{name} rate", unit, factor, model.u[:, k] - seen.u[:, k], noise.rate))
        for k, axis in enumerate("xy"):
            off = model.force[:, k] - seen.force[:, k]
            columns.append(("force", f"force_{axis}", "N", 1.0, off, noise.force))
        columns.append(("centre", "centre", "mm", MILLIMETRE, model.centre - seen.centre, noise.centre))
        rows += [
            {
                "trial": seen.name,
                "quantity": name,
                "unit": unit,
                "rmsd": factor * float(np.sqrt(np.mean(off**2))),
                "noise": factor * size,
            }
            for channel, name, unit, factor, off, size in columns
            if channel in tracks
        ]
    return pd.DataFrame(rows, columns=["trial", "quantity", "unit", "rmsd", "noise"])


def certificate_table(trials: Sequence[TrialResult]) -> pd.DataFrame:
    """What lies between and beyond the points of each motion; empty cells where nothing was certified."""
    rows = []
    for trial in trials:
        c = trial.judged.certificate
        told = {"trial": trial.recorded.name, "certified": "no" if c is None or not c.converged else "yes"}
        told |= {"residual [N]": float(trial.judged.force.max()), "residual [N m]": float(trial.judged.moment.max())}
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


def trial_table(trial: TrialResult, tracks: Sequence[str]) -> pd.DataFrame:
    """Over time: coordinates and plate as recorded and by the model, torques of both legs, residual."""
    seen, model = trial.recorded, trial.model
    columns = {"time [s]": seen.time}
    for k, (name, turns) in enumerate(zip(COORDINATES, TURNING, strict=True)):
        unit, factor = ("deg", DEGREE) if turns else ("mm", MILLIMETRE)
        columns |= {f"{name} [{unit}]": factor * model.q[:, k], f"recorded {name} [{unit}]": factor * seen.q[:, k]}
    for k, axis in enumerate("xy"):
        columns[f"force_{axis} [N]"] = model.force[:, k]
        if "force" in tracks:
            columns[f"plate_force_{axis} [N]"] = seen.force[:, k]
    columns["centre [mm]"] = MILLIMETRE * model.centre
    if "centre" in tracks:
        columns["plate centre [mm]"] = MILLIMETRE * seen.centre
    columns |= {f"{name} torque [N m]": trial.torque[:, k] for k, name in enumerate(JOINTS)}
    columns["residual [N]"] = trial.residual(trial.judged.force)
    columns["residual [N m]"] = trial.residual(trial.judged.moment)
    return pd.DataFrame(columns)
