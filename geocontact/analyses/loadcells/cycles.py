"""Cycles of load cells: those given or found, cut out, their tables.

Styles are compared by the mean of their cycles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame import quantities
from geocontact.analyses.frame.collector import add_input, note, reserve, say
from geocontact.analyses.frame.words import counted
from geocontact.analyses.loadcells.options import FOUND, STANCE, STRIDE, LoadcellOptions
from geocontact.analyses.motion.gait_cycles import cutting_of
from geocontact.data.errors import InputError
from geocontact.data.trial import mean_and_sd
from geocontact.identify.signals.agreement import rms_difference
from geocontact.identify.signals.cycles import STEPS, Span, loaded_spans, normalised, strides, style_shift
from geocontact.identify.signals.filters import gaps
from geocontact.io.recordings.load_cells import read_cycle_table
from geocontact.loads.loadcells import CompartmentForces
from geocontact.view.curves.quantity import SERIES

GivenCycle = tuple[str, Path, Span]
"""Style, recording, times."""


def named_cycles(o: LoadcellOptions) -> list[GivenCycle] | None:
    """Cycles of events, of a table or as typed; None where they are to be found, or none are asked for."""
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


UNLOADED = 0.4  # of the largest total; in swing a knee bears less
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
