"""Cycles of the recordings: found in the total force or at given times, each cut out and brought to 0 … 100 %."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.loadcells.options import STANCE, STRIDE, LoadcellOptions
from geocontact.analyses.loadcells.read import GivenCycle
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.identify.signals.cycles import Span, loaded_spans, normalised, strides
from geocontact.identify.signals.gaps import gaps
from geocontact.loads.loadcells import CompartmentForces

SHARE = 0.25  # of the largest total force, at which load sets in unless told otherwise
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
    record: Record, forces: Mapping[Path, CompartmentForces], given: list[GivenCycle] | None, o: LoadcellOptions
) -> list[Cut]:
    """Every cycle of every recording, those given or those found; an empty list where none are asked for.

    Cycles across a gap of a recording are left out and told.
    """
    if o.cycles is None:
        return []
    cycles = _found(forces, o) if given is None else given
    if not cycles:
        what = f"finds no complete {o.cycles} in {', '.join(path.name for path in forces)}"
        raise InputError("", "`cycles`", what, "see `level`, or name the times: 1.7:2.8,2.8:3.9")
    cuts = [_cut(forces[path], style, path, span, o.part or 1.0) for style, path, span in cycles]
    missing = {path.stem: gaps(f.time) for path, f in forces.items()}
    whole = [cut for cut in cuts if not _across(cut.span, missing[cut.recording])]
    if not whole:
        raise InputError("", "`cycles`", "lie across gaps of the recordings, all of them", "name others: 1.7:2.8")
    if len(whole) < len(cuts):
        record.warn(f"{len(cuts) - len(whole)} of {len(cuts)} cycles lie across gaps of a recording and are left out")
    return whole


def _across(span: Span, missing: list[Span]) -> bool:
    return any(each.start < span.end and span.start < each.end for each in missing)


def stacked(cuts: list[Cut], side: str) -> dict[str, Float[np.ndarray, "_ 101"]]:
    """Curves of one side by style, a row per cycle."""
    styles = dict.fromkeys(cut.style for cut in cuts)
    return {style: np.array([cut.curves[side] for cut in cuts if cut.style == style]) for style in styles}


def _found(forces: Mapping[Path, CompartmentForces], o: LoadcellOptions) -> list[GivenCycle]:
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
