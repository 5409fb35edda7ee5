"""Cycles of the recordings as --cycles asks for them, and what they have in common."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses import quantities
from geocontact.analyses.run_record import Record
from geocontact.cli.loadcells import LoadcellOptions
from geocontact.data.errors import InputError
from geocontact.identify.signals.cycles import STEPS, Span, loaded_spans, normalised, strides
from geocontact.data.ensemble import mean_and_sd
from geocontact.identify.signals.ensemble import rms_difference
from geocontact.io.recordings.cycle_table import read_cycle_table
from geocontact.loads.loadcells import CompartmentForces

SHARE = 0.25  # of the largest total force, at which load sets in unless told otherwise
SIDES = ("medial", "lateral", "total")
FOUND = {"stride": strides, "stance": loaded_spans}


@dataclass(frozen=True)
class Cut:
    """One cycle cut out: medial, lateral and total force at 0 … 100 % [N]."""

    style: str
    recording: str
    span: Span
    curves: dict[str, Float[np.ndarray, " 101"]]


def cuts_asked_for(record: Record, forces: dict[Path, CompartmentForces], o: LoadcellOptions) -> list[Cut]:
    """Every cycle of every recording; an empty list without --cycles."""
    if o.cycles is None:
        _refuse_idle(o)
        return []
    part = 1.0 if o.part is None else quantities.fraction(o.part, "--part")
    if part > 1.0:
        raise InputError("", "--part", f"{o.part!r} is more than the whole", "write for example 60%")
    spans = _spans(record, forces, o)
    if not spans:
        what = f"finds no complete {o.cycles} in {', '.join(path.name for path in forces)}"
        raise InputError("", "--cycles", what, "see --level, or name the times: 1.7:2.8,2.8:3.9")
    cuts = []
    for style, path, span in spans:
        f = forces[path]
        if not f.time[0] <= span.start < span.end <= f.time[-1]:
            what = f"{span.start:g} to {span.end:g} s of a recording from {f.time[0]:g} to {f.time[-1]:g} s"
            raise InputError(path, "--cycles", what, "cycles lie inside the recording")
        end = span.start + part * (span.end - span.start)
        curves = {side: normalised(f.time, values, span.start, end) for side, values in f.curves.items()}
        cuts.append(Cut(style, path.stem, Span(span.start, end), curves))
    return cuts


def _refuse_idle(o: LoadcellOptions) -> None:
    for option, value in (("--part", o.part), ("--level", o.level)):
        if value is not None:
            raise InputError("", option, "does nothing without --cycles", "say what a cycle is")


def _spans(record: Record, forces: dict[Path, CompartmentForces], o: LoadcellOptions) -> list[tuple[str, Path, Span]]:
    asked = (o.cycles or "").strip()
    if asked in FOUND:
        return [
            (path.stem, path, span)
            for path, f in forces.items()
            for span in FOUND[asked](f.time, f.total, _level(f, o))
        ]
    if o.level is not None:
        raise InputError("", "--level", "does nothing here: the cycles are given", "leave it out")
    file = quantities.named_file(asked)
    if file is not None:
        record.add_input("--cycles", file)
        return _from_table(file, list(forces))
    if len(forces) > 1:
        raise InputError("", "--cycles", "times do not say which recording they are of", "give a table of cycles")
    (path,) = forces
    return [(path.stem, path, span) for span in _typed(asked)]


def _level(f: CompartmentForces, o: LoadcellOptions) -> float:
    if o.level is not None and not (np.isfinite(o.level) and o.level > 0.0):
        raise InputError("", "--level", f"{o.level:g} is not a force above 0 N", "e.g. 400")
    return SHARE * float(f.total.max()) if o.level is None else o.level


def _typed(text: str) -> list[Span]:
    spans = []
    for part in text.split(","):
        start, colon, end = part.partition(":")
        if not colon:
            what = f"{part.strip()!r} is neither stride, stance, a file nor start:end"
            raise InputError("", "--cycles", what, "write for example stride or 1.7:2.8,2.8:3.9")
        span = Span(*(quantities.number(value, "--cycles", "1.7:2.8,2.8:3.9") for value in (start, end)))
        if not span.start < span.end:
            raise InputError("", "--cycles", f"{part.strip()!r} ends before it starts", "write start:end in seconds")
        spans.append(span)
    return spans


def _from_table(file: Path, paths: list[Path]) -> list[tuple[str, Path, Span]]:
    known = {path.stem: path for path in paths}
    spans = []
    for row in read_cycle_table(file):
        path = known.get(row.recording) or (paths[0] if len(paths) == 1 and not row.recording else None)
        if path is None:
            what = f"recording {row.recording!r} is not among those given: {', '.join(known)}"
            raise InputError(file, "", what, "write the name of a file without its ending")
        spans.append((row.style, path, Span(row.start, row.end)))
    return spans


def stacked(cuts: list[Cut], side: str) -> dict[str, Float[np.ndarray, "_ 101"]]:
    """Curves of one side by style, a row per cycle."""
    styles = dict.fromkeys(cut.style for cut in cuts)
    return {style: np.array([cut.curves[side] for cut in cuts if cut.style == style]) for style in styles}


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
