"""Contact forces from the load cells, and what their cycles have in common."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.loadcells.cycles import Cut, cuts_asked_for, stacked
from geocontact.analyses.loadcells.options import LoadcellOptions
from geocontact.analyses.loadcells.read import LoadCellInputs
from geocontact.analyses.loadcells.recorded import RecordedCells
from geocontact.analyses.loadcells.result import LoadcellResult
from geocontact.analyses.loadcells.tables import style_table
from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.data.cell_regression import CellRegression
from geocontact.data.seconds import seconds
from geocontact.identify.signals.gaps import gaps
from geocontact.loads.loadcells import compartment_forces
from geocontact.view.curves.given import SERIES

LITTLE = 500.0  # N; a knee under body weight bears more at some time
SLIGHT = 0.01  # of the largest total; less tension than that is an offset not worth a word
SHOWN = 3  # gaps that are named
WHOLE = 1e-6  # how far the two weights of a cell may be from 1 together


def run(given: LoadCellInputs, o: LoadcellOptions, record: Record) -> LoadcellResult:
    """Forces of every recording, and the cycles of all of them."""
    _describe(record, given.regression)
    recorded = {
        path: RecordedCells(path, o.folders[path], r.forces, compartment_forces(r.time, r.forces, given.regression))
        for path, r in given.recordings.items()
    }
    for each in recorded.values():
        _summarise(record, each, given.regression)
    cuts = cuts_asked_for(record, {path: each.forces for path, each in recorded.items()}, given.cycles, o)
    _tell(record, cuts)
    return LoadcellResult(
        record=record, options=o, regression=given.regression, recordings=tuple(recorded.values()), cuts=cuts
    )


def _describe(record: Record, regression: CellRegression) -> None:
    """The weights, and a word where they do not count each cell once."""
    odd = {cell: share for cell, share in regression.shares.items() if abs(share - 1.0) > WHOLE}
    if odd:
        told = ", ".join(f"{cell} {share:g}" for cell, share in odd.items())
        record.warn(f"medial and lateral together do not count each cell's force once: {told}")
    record.results["regression"] = {
        "name": regression.name,
        "source": regression.source,
        "cells": list(regression.cells),
        "medial": list(regression.medial),
        "lateral": list(regression.lateral),
    }


def _summarise(record: Record, r: RecordedCells, regression: CellRegression) -> None:
    f = r.forces
    peaks = {side: float(values.max()) for side, values in f.curves.items()}
    least = -SLIGHT * peaks["total"]
    pulling = {c: float(v.min()) for c, v in r.by_cell(regression).items() if v.min() < least}
    if pulling:
        told = ", ".join(f"{cell} {low:.0f} N" for cell, low in pulling.items())
        record.warn(f"{r.file}: cells are in tension at times ({told}): offsets, or the sign is turned (`map` PM=-PM)")
    if peaks["total"] < LITTLE:
        what = f"the total stays below {peaks['total']:.0f} N, little for a knee that walks"
        record.warn(f"{r.file}: {what}; if the file is in lbf pass `unit` lbf")
    if missing := gaps(f.time):
        times = ", ".join(f"{seconds(each.start)} to {seconds(each.end)} s" for each in missing[:SHOWN])
        more = f" and {len(missing) - SHOWN} more" if len(missing) > SHOWN else ""
        record.warn(f"{r.file}: no samples from {times}{more}: nothing is known of the forces there")
    at = float(f.time[int(np.argmax(f.total))])
    record.results[r.folder or "recording"] = {
        "frames": len(f.time),
        **{f"peak_{side}_N": round(value, 6) for side, value in peaks.items()},
        "peak_total_at_s": round(at, 6),
    }
    label = f"{r.folder}: " if r.folder else ""
    told = ", ".join(f"{side} {value:.1f} N" for side, value in peaks.items())
    record.say(f"{label}largest forces: {told} (total at {seconds(round(at, 3))} s)")


def _tell(record: Record, cuts: list[Cut]) -> None:
    if not cuts:
        return
    counts = {style: len(trials) for style, trials in stacked(cuts, "total").items()}
    record.results["cycles"] = counts
    record.say(", ".join(f"{counted(count, 'cycle')} of {style}" for style, count in counts.items()))
    if max(counts.values()) == 1:
        record.warn("one cycle per style: means are single cycles, and there is no spread to show")
    if len(counts) > 1:
        table = style_table(cuts)
        record.results["styles"] = table.to_dict(orient="records")
        record.say(table.to_string(index=False, float_format=lambda value: f"{value:.1f}"))
    if len(counts) > SERIES:
        record.warn(f"{len(counts)} styles are more than a figure tells apart ({SERIES}); ensemble.csv has them all")
