"""Forces of a model beside those of the mat: how they agree, over all and per phase."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.mat.comparison.model_forces import UNITS, ModelForces, model_curves
from geocontact.analyses.mat.comparison.phases import Phase, frames_of
from geocontact.analyses.mat.load_table import load_table
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import Agreement, agreement, over_stretches, per_phase
from geocontact.identify.signals.even_times import at_times, even_times
from geocontact.loads.mat.load import MatLoad

PARTS = 10

Curve = Float[np.ndarray, " t"]


def compared(
    record: Record, model: ModelForces, phases: tuple[Phase, ...] | None, whole: MatLoad, time: Curve, o: MatOptions
) -> pd.DataFrame:
    """One row per channel and phase ("all", then those that are named, or "0-10 %", …)."""
    if len(time) < 3 * PARTS:
        raise InputError(model.file, "", f"{len(time)} frames are too few to compare", f"{3 * PARTS} are needed")
    even, step = even_times(time)
    if even is not time:
        record.warn("frames are not evenly spaced: agreement is told at even times, without what lies in gaps")
    measured = load_table(whole, time)
    in_phases = _phases(phases, even, step, o)
    rows = [
        {"channel": name, "unit": UNITS[name], "phase": phase, **asdict(each)}
        for name, theirs in model_curves(record, model, whole.wrench, time, o).items()
        for model_there in [at_times(time, theirs, even, step)]
        for ours in [at_times(time, measured[f"{name} [{UNITS[name]}]"].to_numpy(float), even, step)]
        for phase, each in {"all": agreement(model_there, ours, step), **in_phases(model_there, ours)}.items()
    ]
    agreed = pd.DataFrame(rows).rename(columns={"lag": "lag [s]", "r2": "r2 [-]", "correlation": "correlation [-]"})
    if not (agreed.loc[agreed["phase"] == "all", "samples"] > 0).any():
        raise InputError(model.file, "", "has no time in common with the mat", "check its time column")
    _tell(record, agreed[agreed["phase"] == "all"])
    return agreed


def _tell(record: Record, whole: pd.DataFrame) -> None:
    record.results["agreement"] = whole.replace({np.nan: None}).to_dict(orient="records")
    for row in whole.itertuples():
        record.say(f"{row.channel}: mean absolute difference {row.mae:.4g} {row.unit}, root mean square {row.rmsd:.4g}")


def _phases(
    phases: tuple[Phase, ...] | None, time: Curve, step: float, o: MatOptions
) -> Callable[[Curve, Curve], dict[str, Agreement]]:
    """Agreement by name of the phase: tenths of the recording where nobody names any."""
    if phases is None:
        names = [f"{100 * k // PARTS}-{100 * (k + 1) // PARTS} %" for k in range(PARTS)]
        return lambda model, ours: dict(zip(names, per_phase(model, ours, step, PARTS), strict=True))
    found = frames_of(phases, time, o)
    return lambda model, ours: {name: over_stretches(model, ours, step, parts) for name, parts in found.items()}
