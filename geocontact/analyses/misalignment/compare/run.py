"""A model of the elbow beside recordings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.compare.pair import QUANTITIES, Pair
from geocontact.analyses.misalignment.compare.read import Both, ComparedLaw
from geocontact.analyses.misalignment.compare.result import CompareResult
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.synthetic import ideal
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import agreement
from geocontact.identify.signals.even_times import at_times, even_times

SAME_MOTION = float(np.radians(2.0))
"""rad, root mean square, that angles of a recording and its model may be apart."""


def run(both: Both, o: CompareOptions, record: Record) -> CompareResult:
    """Errors of every channel that a recording and its model have."""
    measured = both.measured
    models = _simulated(both.model, o, measured) if isinstance(both.model, ComparedLaw) else both.model
    each = zip(o.recordings, measured, models, strict=True)
    found = tuple(pair for path, r, model in each for pair in _pairs(path, r, model))
    record.results["comparison"] = [{"trial": p.trial, "channel": p.channel, **asdict(p.agreement)} for p in found]
    for p in found:
        a, q = p.agreement, QUANTITIES[p.channel]
        if a.r2 < 0.0:
            record.warn(f"{p.trial}, {p.channel}: R² is {a.r2:.2f}, a constant would do better: is a sign turned?")
        errors = f"MAE {q.per_si * a.mae:.3g}, RMSE {q.per_si * a.rmsd:.3g} {q.unit}"
        record.say(f"{p.trial}, {p.channel}: {errors}, R² {a.r2:.3f}")
    return CompareResult(record=record, options=o, pairs=found)


def _simulated(law: ComparedLaw, o: CompareOptions, measured: Sequence[ElbowRecording]) -> list[ElbowRecording]:
    """The identified law along each recording's angle and cuff pressure."""
    found = []
    for path, r in zip(o.recordings, measured, strict=True):
        if law.numbers["s"] != 0.0 and r.pressure is None:
            raise InputError(path, "", "the law's stiffness follows the cuff's pressure, which is not here", "add it")
        pressure = 0.0 if r.pressure is None else r.pressure - law.pressure
        try:
            force, joint = ideal(r.time, r.beta, law.numbers, o.stroke, pressure)
        except ValueError as error:
            raise InputError(path, "", str(error), "the identified law does not reach these angles") from error
        found.append(ElbowRecording(r.name, r.time, r.beta, force, None if o.stroke is None else joint, r.pressure))
    return found


def _pairs(path: Path, measured: ElbowRecording, model: ElbowRecording) -> list[Pair]:
    """Channels that both have, at the measured trial's even times within both."""
    time, step = even_times(measured.time)
    inside = (time >= model.time[0]) & (time <= model.time[-1])
    if inside.sum() < 2:
        spans = f"{measured.time[0]:g} to {measured.time[-1]:g} s, the model {model.time[0]:g} to {model.time[-1]:g} s"
        raise InputError(path, "", f"runs from {spans}", "shift the clock of one of them")
    both = [("force", measured.force, model.force)]
    if measured.displacement is not None and model.displacement is not None:
        both.append(("displacement", measured.displacement, model.displacement))
    beta = at_times(measured.time, measured.beta, time, step)[inside]
    apart = float(np.sqrt(np.nanmean((beta - np.interp(time[inside], model.time, model.beta)) ** 2)))
    if apart > SAME_MOTION:
        what = f"its angle is {np.degrees(apart):.1f} degrees, root mean square, from that of the model's recording"
        raise InputError(path, "", what, "give the simulated recordings in the same order")
    found = []
    for channel, ours, theirs in both:
        here = at_times(measured.time, ours, time, step)[inside]
        there = np.interp(time[inside], model.time, theirs)
        found.append(Pair(measured.name, channel, time[inside], beta, here, there, agreement(there, here, step)))
    return found
