"""Forces of a model beside those of the mat: how they agree, over all and per phase."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pandas as pd

from geocontact.cli.mat import MatOptions
from geocontact.cli.mat_results import Result, load_table
from geocontact.cli.record import Record
from geocontact.data.errors import InputError
from geocontact.identify.agreement import agreement, per_phase
from geocontact.io.tables import read_table
from geocontact.io.units import si_unit

PARTS = 10
COMPARED = ("fx", "fy", "fz", "mx", "my", "mz", "normal", "perpendicular")


def compared(record: Record, result: Result, o: MatOptions) -> pd.DataFrame | None:
    """One row per channel and stretch of the recording ("all", "0-10 %", …); None without --compare."""
    if o.compare is None:
        return None
    table = read_table(o.compare)
    record.add_input("--compare", o.compare, rows=len(table.time))
    time = result.seen.frames.time
    if len(time) < 3 * PARTS:
        raise InputError(o.compare, "", f"{len(time)} frames are too few to compare", f"{3 * PARTS} are needed")
    step = float(np.median(np.diff(time)))
    ours = load_table(result.whole, time)
    rows = []
    for name in COMPARED:
        if name not in table.channels:
            continue
        column = next(label for label in ours.columns if label.startswith(f"{name} ["))
        unit = column.partition("[")[2].rstrip("]")
        known = si_unit(table.units[table.channels.index(name)])
        if known is None or known[0] != unit:
            raise InputError(o.compare, "", f"column '{name}' is not in {unit}", f"write `{column}`")
        model = known[1] * np.interp(time, table.time, table.needed(name), np.nan, np.nan)
        measured = ours[column].to_numpy(float)
        stretches = [f"{100 * k // PARTS}-{100 * (k + 1) // PARTS} %" for k in range(PARTS)]
        found = [agreement(model, measured, step), *per_phase(model, measured, step, PARTS)]
        rows += [
            {"channel": name, "unit": unit, "phase": phase, **asdict(each)}
            for phase, each in zip(("all", *stretches), found, strict=True)
        ]
    if not rows:
        raise InputError(o.compare, "", "holds none of our columns", f"name them {', '.join(COMPARED)} with their unit")
    agreed = pd.DataFrame(rows).rename(columns={"lag": "lag [s]", "r2": "r2 [-]", "correlation": "correlation [-]"})
    whole = agreed[agreed["phase"] == "all"]
    if not (whole["samples"] > 0).any():
        raise InputError(o.compare, "", "has no time in common with the mat", "check its time column")
    record.results["agreement"] = whole.replace({np.nan: None}).to_dict(orient="records")
    for row in whole.itertuples():
        record.say(f"{row.channel}: mean absolute difference {row.mae:.4g} {row.unit}, root mean square {row.rmsd:.4g}")
    return agreed
