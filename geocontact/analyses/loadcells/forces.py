"""Contact forces from the load cells of an implant: recordings read, compartments, cycles, tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame import quantities
from geocontact.analyses.frame.collector import add_input, judge, note, reserve, say
from geocontact.analyses.frame.words import counted
from geocontact.analyses.loadcells.goodness import SLIGHT, goodness_of_cells
from geocontact.analyses.loadcells.options import FOUND, STANCE, STRIDE, LoadcellOptions
from geocontact.analyses.motion.gait_cycles import cutting_of
from geocontact.data.cell_regression import CellRegression
from geocontact.data.errors import InputError
from geocontact.data.text import seconds
from geocontact.data.trial import mean_and_sd
from geocontact.identify.signals.agreement import rms_difference
from geocontact.identify.signals.cycles import STEPS, Span, loaded_spans, normalised, strides, style_shift
from geocontact.identify.signals.filters import gaps
from geocontact.io.recordings.load_cells import CellRecording, read_cycle_table, read_load_cells, read_regression
from geocontact.io.text.columns import parse_map
from geocontact.io.text.results import frame_of
from geocontact.loads.loadcells import PUBLISHED, CompartmentForces, compartment_forces
from geocontact.trial_checks.channel_checks import odd_rate
from geocontact.view.curves.quantity import SERIES

GivenCycle = tuple[str, Path, Span]
"""Style, recording, times."""


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
    return LoadCellInputs(regression, recordings, _named_cycles(o))


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


def _named_cycles(o: LoadcellOptions) -> list[GivenCycle] | None:
    cutting = cutting_of(o.events, o.cycle_side, o.part)
    if cutting is not None:
        cycles = [(path, each) for path in o.recordings for each in cutting.cycles_of(path.stem)]
        return [(each.style, path, Span(each.start, each.end)) for path, each in cycles]
    asked = (o.cycles or "").strip()
    if o.cycles is None or asked in FOUND:
        return None
    file = quantities.named_file(asked)
    if file is not None:
        add_input("`cycles`", file)
        return _from_table(file, o.recordings)
    if len(o.recordings) > 1:
        raise InputError("", "`cycles`", "it is unclear to which recording the times belong", "give a table of cycles")
    (path,) = o.recordings
    return [(path.stem, path, span) for span in _typed(asked)]


def _typed(text: str) -> list[Span]:
    spans = []
    for part in text.split(","):
        start, colon, end = part.partition(":")
        if not colon:
            what = f"{part.strip()!r} is neither stride, stance, a file nor start:end"
            raise InputError("", "`cycles`", what, "write for example stride or 1.7:2.8,2.8:3.9")
        span = Span(*(quantities.number(value, "`cycles`", "1.7:2.8,2.8:3.9") for value in (start, end)))
        if not span.start < span.end:
            raise InputError("", "`cycles`", f"{part.strip()!r} ends before it starts", "write start:end in seconds")
        spans.append(span)
    return spans


def _from_table(file: Path, paths: tuple[Path, ...]) -> list[GivenCycle]:
    known = {path.stem: path for path in paths}
    spans = []
    for row in read_cycle_table(file):
        path = known.get(row.recording) or (paths[0] if len(paths) == 1 and not row.recording else None)
        if path is None:
            what = f"recording {row.recording!r} is not among those given: {', '.join(known)}"
            raise InputError(file, "", what, "write the name of a file without its ending")
        spans.append((row.style, path, Span(row.start, row.end)))
    return spans


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


SHARE = 0.25  # of the largest total force, at which load sets in by default
SIDES = ("medial", "lateral", "total")
FINDERS = {STRIDE: strides, STANCE: loaded_spans}


@dataclass(frozen=True)
class Cut:
    """One cycle cut out: medial, lateral and total force at 0 … 100 % [N]."""

    style: str
    recording: str
    span: Span
    curves: dict[str, Float[np.ndarray, " 101"]]


def cuts_asked_for(
    forces: Mapping[Path, CompartmentForces], given: list[GivenCycle] | None, o: LoadcellOptions
) -> list[Cut]:
    """Every cycle of every recording, those given or those found; an empty list where none are asked for.

    Cycles across a gap of a recording are left out, with a warning.
    """
    if o.cycles is None and given is None:
        return []
    cycles = _cycles_of(forces, o) if given is None else given
    if not cycles:
        what = f"finds no complete {o.cycles} in {', '.join(path.name for path in forces)}"
        least, most = (float(pick([pick(f.total) for f in forces.values()])) for pick in (min, max))
        if least > UNLOADED * most:
            what += f", whose total is never below {least:.0f} N: were the cells set to zero?"
        raise InputError("", "`cycles`", what, "see `level`, or name the times: 1.7:2.8,2.8:3.9")
    cuts = [_cut(forces[path], style, path, span, _share(o)) for style, path, span in cycles]
    missing = {path.stem: gaps(f.time) for path, f in forces.items()}
    whole = [cut for cut in cuts if not _across(cut.span, missing[cut.recording])]
    if not whole:
        raise InputError("", "`cycles`", "all contain gaps of the recordings", "name others: 1.7:2.8")
    if len(whole) < len(cuts):
        reserve(f"{len(cuts) - len(whole)} of {len(cuts)} cycles contain gaps of a recording and are left out")
    return whole


def _share(o: LoadcellOptions) -> float:
    """First part of the cycles' spans; those of events end where the part does."""
    return 1.0 if o.part is None or o.part == STANCE or o.events is not None else float(o.part)


def _across(span: Span, missing: list[Span]) -> bool:
    return any(each.start < span.end and span.start < each.end for each in missing)


def stacked(cuts: list[Cut], side: str) -> dict[str, Float[np.ndarray, "_ 101"]]:
    """Curves of one side by style, a row per cycle."""
    styles = dict.fromkeys(cut.style for cut in cuts)
    return {style: np.array([cut.curves[side] for cut in cuts if cut.style == style]) for style in styles}


def _cycles_of(forces: Mapping[Path, CompartmentForces], o: LoadcellOptions) -> list[GivenCycle]:
    spans = FINDERS[(o.cycles or "").strip()]
    return [(path.stem, path, span) for path, f in forces.items() for span in spans(f.time, f.total, _level(f, o))]


def _level(f: CompartmentForces, o: LoadcellOptions) -> float:
    return SHARE * float(f.total.max()) if o.level is None else o.level


def _cut(f: CompartmentForces, style: str, path: Path, span: Span, part: float) -> Cut:
    """The first part of one cycle."""
    if not f.time[0] <= span.start < span.end <= f.time[-1]:
        what = f"{span.start:g} to {span.end:g} s of a recording from {f.time[0]:g} to {f.time[-1]:g} s"
        raise InputError(path, "`cycles`", what, "cycles lie inside the recording")
    end = span.start + part * (span.end - span.start)
    curves = {side: normalised(f.time, values, span.start, end) for side, values in f.curves.items()}
    return Cut(style, path.stem, Span(span.start, end), curves)


def cycle_table(cuts: list[Cut]) -> pd.DataFrame:
    """A row per cycle with its largest forces."""
    rows: list[dict[str, object]] = [
        {
            "style": cut.style,
            "recording": cut.recording,
            "start [s]": cut.span.start,
            "end [s]": cut.span.end,
            **{f"peak_{side} [N]": float(cut.curves[side].max()) for side in SIDES},
        }
        for cut in cuts
    ]
    return pd.DataFrame(rows)


def ensemble_table(cuts: list[Cut]) -> pd.DataFrame:
    """Mean and SD of every style at each per cent; the SD is empty where a style has one cycle."""
    parts = []
    for style, trials in stacked(cuts, "total").items():
        columns: dict[str, object] = {"style": [style] * len(STEPS), "cycle [%]": STEPS, "cycles [-]": len(trials)}
        for side in SIDES:
            mean, sd = mean_and_sd(stacked(cuts, side)[style])
            columns |= {f"{side}_mean [N]": mean, f"{side}_sd [N]": sd}
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def style_table(cuts: list[Cut]) -> pd.DataFrame:
    """Root mean square difference of every further style's mean to that of the first."""
    rows: list[dict[str, object]] = []
    first, *others = dict.fromkeys(cut.style for cut in cuts)
    means = {side: {s: mean_and_sd(t)[0] for s, t in stacked(cuts, side).items()} for side in SIDES}
    for style in others:
        off = {f"rmse_{side} [N]": rms_difference(means[side][style], means[side][first]) for side in SIDES}
        rows.append({"style": style, "reference": first, **off})
    return pd.DataFrame(rows)


def shift_table(cuts: list[Cut]) -> pd.DataFrame:
    """How much more every further style swings than the first, and how much later it is, with intervals of 95 %."""
    rows: list[dict[str, object]] = []
    first, *others = dict.fromkeys(cut.style for cut in cuts)
    for style in others:
        for side in SIDES:
            curves = stacked(cuts, side)
            found = style_shift(curves[style], curves[first])
            row: dict[str, object] = {"style": style, "reference": first, "side": side}
            row["cycles [-]"], row["reference_cycles [-]"] = len(curves[style]), len(curves[first])
            for name, unit, told in (
                ("peak_to_peak_difference", "N", found.swing),
                ("peak_difference", "N", found.peak),
                ("later", "%", found.later),
                ("peak_later", "%", found.peak_later),
            ):
                row |= {f"{name} [{unit}]": told.value}
                row |= {f"{name}_{end} [{unit}]": getattr(told, end) for end in ("lower", "upper")}
            rows.append({**row, "correlation [-]": found.correlation})
    return pd.DataFrame(rows)


LITTLE = 500.0  # N; a knee under body weight bears more at some time
UNLOADED = 0.4  # of the largest total; in swing a knee bears less
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


def say_cycles(cuts: list[Cut]) -> None:
    """How many cycles there are, and how styles differ."""
    if not cuts:
        return
    counts = {style: len(trials) for style, trials in stacked(cuts, "total").items()}
    note("cycles", counts)
    say(", ".join(f"{counted(count, 'cycle')} of {style}" for style, count in counts.items()))
    if max(counts.values()) == 1:
        reserve("one cycle per style: means are single cycles, and there is no spread to show")
    if len(counts) > 1:
        table = style_table(cuts)
        note("styles", table.to_dict(orient="records"))
        say(table.to_string(index=False, float_format=lambda value: f"{value:.1f}"))
    if len(counts) > SERIES:
        reserve(f"{len(counts)} styles are more than a figure can show ({SERIES}); ensemble.csv has them all")
