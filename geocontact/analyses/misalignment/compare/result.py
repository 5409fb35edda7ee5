"""A model beside recordings: the comparison of every trial and channel, table, figures, page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.compare.pairs import QUANTITIES, Both, ComparedLaw, Pair
from geocontact.analyses.misalignment.compare.show import comparison_figure, comparison_page
from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.synthetic import ideal
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import agreement
from geocontact.identify.signals.even_times import at_times, even_times
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CompareResult(Result):
    """A model beside recordings.

    Parameters
    ----------
    pairs
        Each channel of each trial.
    """

    options: CompareOptions
    pairs: tuple[Pair, ...]

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that were compared."""
        return tuple(channel for channel in QUANTITIES if any(p.channel == channel for p in self.pairs))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison`: one row per trial and channel; lengths in mm."""
        return {"comparison": pd.DataFrame([_row(pair) for pair in self.pairs])}

    def figure(self, channel: str = "force") -> Figure:
        """One channel over the angle, all trials; KeyError names those that there are."""
        if channel not in self.channels:
            raise KeyError(f"no channel {channel!r}; there are {', '.join(self.channels)}")
        mine = [p for p in self.pairs if p.channel == channel]
        beta, measured, model = zip(*(p.binned(self.options.bin).T for p in mine), strict=True)
        return comparison_figure([p.trial for p in mine], beta, measured, model, QUANTITIES[channel])

    def figures(self) -> dict[str, Figure]:
        """`comparison_force` and so on, a channel each."""
        return {f"comparison_{each}": self.figure(each) for each in self.channels}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The first trial over time, figures and errors."""
        shown = frame_table("Errors by trial and channel", self.table())
        drawn = {each: drawings[f"comparison_{each}"] for each in self.channels}
        return {REPORT: comparison_page(self.pairs, drawn, [shown], self.record)}


def _row(p: Pair) -> dict[str, object]:
    a, q = p.agreement, QUANTITIES[p.channel]
    return {
        "trial": p.trial,
        "channel": p.channel,
        "unit": q.unit,
        "mae": a.mae * q.per_si,
        "rmse": a.rmsd * q.per_si,
        "bias": a.bias * q.per_si,
        "r2 [-]": a.r2,
        "lag [s]": a.lag,
        "samples": a.samples,
    }


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
