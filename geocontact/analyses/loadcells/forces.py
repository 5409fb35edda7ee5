"""Contact forces from the load cells of an implant: recordings read, compartments, what is odd in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, judge, note, reserve, say
from geocontact.analyses.loadcells.cycles import Cut, GivenCycle, named_cycles
from geocontact.analyses.loadcells.goodness import SLIGHT, goodness_of_cells
from geocontact.analyses.loadcells.options import LoadcellOptions
from geocontact.data.cell_regression import CellRegression
from geocontact.data.text import seconds
from geocontact.identify.signals.filters import gaps
from geocontact.io.recordings.load_cells import CellRecording, read_load_cells, read_regression
from geocontact.io.text.columns import parse_map
from geocontact.io.text.results import frame_of
from geocontact.loads.loadcells import PUBLISHED, CompartmentForces, compartment_forces
from geocontact.trial_checks.channel_checks import odd_rate


@dataclass(frozen=True)
class LoadCellInputs:
    """Recordings by file, weights of their cells, and the cycles whose times are given; None where none are."""

    regression: CellRegression
    recordings: dict[Path, CellRecording]
    cycles: list[GivenCycle] | None


def read(o: LoadcellOptions) -> LoadCellInputs:
    """Everything the options name."""
    regression = PUBLISHED
    if o.matrix is not None:
        regression = read_regression(o.matrix)
        add_input("`matrix`", o.matrix)
    mapping = {} if o.map is None else parse_map(o.map, regression.cells)
    recordings = {path: read_load_cells(path, regression.cells, o.unit, mapping) for path in o.recordings}
    for path, folder in o.folders.items():
        r = recordings[path]
        add_input("recording", path, unit=r.unit, frames=len(r.time), folder=folder or ".")
        _doubt_cells(path.name, r.time, dict(zip(regression.cells, r.forces.T, strict=True)))
    return LoadCellInputs(regression, recordings, named_cycles(o))


def _doubt_cells(file: str, time: Float[np.ndarray, " t"], cells: Mapping[str, Float[np.ndarray, " t"]]) -> None:
    """A warning for an odd clock, for a cell that reads one value while others change, and for one that is another."""
    for one in odd_rate(file, "", time):
        reserve(str(one))
    total = float(np.nanmax(np.abs(sum(cells.values())), initial=0.0))
    ranges = {name: float(np.ptp(values[np.isfinite(values)])) for name, values in cells.items()}
    for name, span in ranges.items():
        if span < STILL * total < max(ranges.values()):
            reserve(f"{file}: {name} reads {np.nanmedian(cells[name]):.4g} N all the time: does the cell work?")
    for name, other in combinations(cells, 2):
        if ranges[name] > STILL * total and np.array_equal(cells[name], cells[other], equal_nan=True):
            reserve(f"{file}: {name} and {other} are equal sample by sample: name the column of each cell, see `map`")
    for name in cells:
        if ranges[name] >= STILL * total and (words := _held(name, time, cells, CHANGE * total)):
            reserve(f"{file}: {words}: was it off or at its end? leave those samples empty")


def _held(name: str, time: Float[np.ndarray, " t"], cells: Mapping[str, Float[np.ndarray, " t"]], change: float) -> str:
    """The first time that a cell has one value while another one changes by more than `change` [N], in words."""
    edges = np.flatnonzero(np.diff(np.r_[np.nan, cells[name], np.nan]) != 0.0)
    for start, stop in pairwise(edges):
        if stop - start < HELD:
            continue
        others = {other: values[start:stop] for other, values in cells.items() if other != name}
        moved = {other: float(np.ptp(values[np.isfinite(values)])) for other, values in others.items()}
        most = max(moved, key=moved.__getitem__)
        if moved[most] > change:
            when = f"from {time[start]:.2f} to {time[stop - 1]:.2f} s"
            return f"{name} reads {cells[name][start]:.4g} N {when}, while {most} changes by {moved[most]:.0f} N"
    return ""


def doubt_drift(recorded: RecordedCells, regression: CellRegression, cuts: list[Cut]) -> None:
    """A warning for a cell whose least force in the cycles of a recording rises or falls from the first to the last."""
    spans = [cut.span for cut in cuts if cut.recording == recorded.file.stem]
    largest = float(np.max(recorded.forces.total))
    if len(spans) < CYCLES:
        return
    time = recorded.forces.time
    for name, values in recorded.by_cell(regression).items():
        least = np.array([values[(time >= one.start) & (time <= one.end)].min() for one in spans])
        fall = np.diff(least)
        if abs(least[-1] - least[0]) > DRIFTS * largest and (np.sign(fall) == np.sign(least[-1] - least[0])).all():
            what = f"the least force of {name} goes from {least[0]:.0f} to {least[-1]:.0f} N over {len(spans)} cycles"
            reserve(f"{recorded.file.name}: {what}: does the cell drift?")


@dataclass(frozen=True)
class RecordedCells:
    """A recording with the forces of its cells and of the compartments [N].

    Parameters
    ----------
    file
        Where it was read from.
    folder
        Of its results; empty where there is one recording.
    cells
        Columns in the order of the regression's cells.
    """

    file: Path
    folder: str
    cells: Float[np.ndarray, "t c"]
    forces: CompartmentForces

    def by_cell(self, regression: CellRegression) -> dict[str, Float[np.ndarray, " t"]]:
        """Forces of the cells by name [N]."""
        return dict(zip(regression.cells, self.cells.T, strict=True))

    def table(self) -> pd.DataFrame:
        """Forces of the compartments over time."""
        columns = {f"{side} [N]": values for side, values in self.forces.curves.items()}
        return frame_of({"time [s]": self.forces.time, **columns})


LITTLE = 500.0  # N; a knee under body weight bears more at some time
LIGHT = 1.05  # weights; walking 2.6, standing on both legs 1.07 (Kutzner, there)
MUCH = 5000.0  # N; five times 100 kg, down stairs it is 3.5 times the weight (Kutzner, J Biomech 43, 2010)
HELD, CHANGE = 8, 0.05  # samples of one value, and the change of another cell meanwhile, of the largest total
CYCLES, DRIFTS = 3, 0.1  # from which least forces are compared, and by how much of the largest total they differ
STILL = 1e-3  # of the largest total; what a cell reads more or less where it works
SHOWN = 3  # gaps that are named
WHOLE = 1e-6  # how far the two weights of a cell may be from 1 together


def recorded_forces(given: LoadCellInputs, o: LoadcellOptions) -> tuple[RecordedCells, ...]:
    """Forces of every recording, and what is to be said of them."""
    _describe(given.regression)
    recorded = tuple(
        RecordedCells(path, o.folders[path], r.forces, compartment_forces(r.time, r.forces, given.regression))
        for path, r in given.recordings.items()
    )
    for each in recorded:
        judge(goodness_of_cells(each.file.name, each.forces.total, each.by_cell(given.regression)))
    for each in recorded:
        _summarise(each, given.regression, o.body_weight)
    return recorded


def _describe(regression: CellRegression) -> None:
    """The weights, and a word where they do not count each cell once."""
    odd = {cell: share for cell, share in regression.shares.items() if abs(share - 1.0) > WHOLE}
    if odd:
        told = ", ".join(f"{cell} {share:g}" for cell, share in odd.items())
        reserve(f"medial and lateral weights of a cell do not sum to 1: {told}")
    note(
        "regression",
        {
            "name": regression.name,
            "source": regression.source,
            "cells": list(regression.cells),
            "medial": list(regression.medial),
            "lateral": list(regression.lateral),
        },
    )


def _summarise(r: RecordedCells, regression: CellRegression, weight: float | None) -> None:
    f = r.forces
    peaks = {side: float(values.max()) for side, values in f.curves.items()}
    least = -SLIGHT * peaks["total"]
    pulling = {c: float(v.min()) for c, v in r.by_cell(regression).items() if v.min() < least}
    if pulling:
        told = ", ".join(f"{cell} {low:.0f} N" for cell, low in pulling.items())
        reserve(f"{r.file}: cells are in tension at times ({told}): offsets, or the sign is turned (`map` PM=-PM)")
    if peaks["total"] < LITTLE:
        what = f"the total stays below {peaks['total']:.0f} N, little for a knee that walks"
        reserve(f"{r.file}: {what}; if the file is in lbf pass `unit` lbf")
    elif weight is not None and peaks["total"] < LIGHT * weight:
        what = (
            f"the total stays below {peaks['total'] / weight:.2f} times the body's weight, little for a knee that walks"
        )
        reserve(f"{r.file}: {what}; are `body_mass` in kg and the forces in their unit?")
    if peaks["total"] > MUCH:
        what = f"the total reaches {peaks['total']:.0f} N, much for a knee"
        reserve(f"{r.file}: {what}; is its unit right, N or lbf? see `unit`")
    if missing := gaps(f.time):
        times = ", ".join(f"{seconds(each.start)} to {seconds(each.end)} s" for each in missing[:SHOWN])
        more = f" and {len(missing) - SHOWN} more" if len(missing) > SHOWN else ""
        reserve(f"{r.file}: no samples from {times}{more}: the forces there are unknown")
    at = float(f.time[int(np.argmax(f.total))])
    note(
        r.folder or "recording",
        {
            "frames": len(f.time),
            **{f"peak_{side}_N": round(value, 6) for side, value in peaks.items()},
            "peak_total_at_s": round(at, 6),
        },
    )
    label = f"{r.folder}: " if r.folder else ""
    told = ", ".join(f"{side} {value:.1f} N" for side, value in peaks.items())
    say(f"{label}largest forces: {told} (total at {seconds(round(at, 3))} s)")
