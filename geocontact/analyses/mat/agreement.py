"""Forces of a model beside those of the mat: how they agree, over all and per phase."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.mat.model_forces import UNITS, model_curves
from geocontact.analyses.mat.phases import read_phases
from geocontact.analyses.mat.write import Result, load_table
from geocontact.analyses.run_record import Record
from geocontact.cli.mat import MatOptions
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import Agreement, agreement, over_stretches, per_phase
from geocontact.identify.signals.even_times import at_times, even_times

PARTS = 10

Curve = Float[np.ndarray, " t"]


def compared(record: Record, result: Result, o: MatOptions) -> pd.DataFrame | None:
    """One row per channel and phase ("all", then those of --phases, or "0-10 %", …); None without --compare."""
    if o.compare is None:
        if o.phases is not None:
            raise InputError("", "--phases", "does nothing without --compare", "leave it out")
        return None
    time = result.seen.frames.time
    if len(time) < 3 * PARTS:
        raise InputError(o.compare, "", f"{len(time)} frames are too few to compare", f"{3 * PARTS} are needed")
    even, step = even_times(time)
    if even is not time:
        record.warn("frames are not evenly spaced: agreement is told at even times, without what lies in gaps")
    measured = load_table(result.whole, time)
    in_phases = _phases(record, even, step, o)
    rows = [
        {"channel": name, "unit": UNITS[name], "phase": phase, **asdict(each)}
        for name, theirs in model_curves(record, result.whole.wrench, time, o).items()
        for model in [at_times(time, theirs, even, step)]
        for ours in [at_times(time, measured[f"{name} [{UNITS[name]}]"].to_numpy(float), even, step)]
        for phase, each in {"all": agreement(model, ours, step), **in_phases(model, ours)}.items()
    ]
    agreed = pd.DataFrame(rows).rename(columns={"lag": "lag [s]", "r2": "r2 [-]", "correlation": "correlation [-]"})
    whole = agreed[agreed["phase"] == "all"]
    if not (whole["samples"] > 0).any():
        raise InputError(o.compare, "", "has no time in common with the mat", "check its time column")
    record.results["agreement"] = whole.replace({np.nan: None}).to_dict(orient="records")
    for row in whole.itertuples():
        record.say(f"{row.channel}: mean absolute difference {row.mae:.4g} {row.unit}, root mean square {row.rmsd:.4g}")
    return agreed


def _phases(record: Record, time: Curve, step: float, o: MatOptions) -> Callable[[Curve, Curve], dict[str, Agreement]]:
    """Agreement by name of the phase: tenths of the recording where nobody names any."""
    if o.phases is None:
        names = [f"{100 * k // PARTS}-{100 * (k + 1) // PARTS} %" for k in range(PARTS)]
        return lambda model, ours: dict(zip(names, per_phase(model, ours, step, PARTS), strict=True))
    phases = read_phases(record, o.phases, time)
    return lambda model, ours: {name: over_stretches(model, ours, step, parts) for name, parts in phases.items()}
