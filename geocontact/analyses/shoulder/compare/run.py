"""Errors of a simulated arm, over the whole trial, over the work and in each phase."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.analyses.shoulder.compare.read import ArmAndRecording
from geocontact.analyses.shoulder.compare.result import ComparedChannel, ShoulderCompareResult
from geocontact.analyses.shoulder.phase_errors import ALL, WORK, phase_errors
from geocontact.analyses.shoulder.recorded_channels import ELEVATION
from geocontact.analyses.shoulder.reservations import out_of_cuff_words
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import Agreement
from geocontact.identify.signals.even_times import at_times, even_times


def run(both: ArmAndRecording, o: ShoulderCompareOptions, record: Record) -> ShoulderCompareResult:
    """Every channel that was recorded."""
    time, step = even_times(both.simulated.time)
    recorded = both.recorded
    inside = (time >= recorded.time[0] - 1e-9) & (time <= recorded.time[-1] + 1e-9)
    if inside.sum() < 2:
        ours, theirs = (f"{each.time[0]:g} to {each.time[-1]:g} s" for each in (both.simulated, recorded))
        raise InputError(o.recorded, "", f"runs from {theirs}, the simulation from {ours}", "give `delay`")
    if not inside.all():
        record.warn(f"{o.recorded.name}: {inside.mean():.0%} of the simulated time was recorded")
    phase = np.array(both.phase)
    _, recorded_step = even_times(recorded.time)
    found = []
    for channel, values in recorded.values.items():
        measured = at_times(recorded.time, values, time, recorded_step)
        model = both.simulated.values[channel]
        errors = phase_errors(model, measured, step, phase, inside)
        found.append(ComparedChannel(channel, time, model, np.where(inside, measured, np.nan), errors))
        _say(found[-1], errors, out_of_cuff_words(both.out_of_cuff), record)
    record.results["comparison"] = plain(
        {each.channel: {name: vars(error) for name, error in each.errors.items()} for each in found}
    )
    return ShoulderCompareResult(record=record, options=o, channels=tuple(found))


def _say(one: ComparedChannel, errors: Mapping[str, Agreement], reserved: str, record: Record) -> None:
    unit, factor = ("deg", np.degrees(1.0)) if one.channel == ELEVATION else ("N", 1.0)
    for name in (ALL, WORK):
        if name in errors:
            a = errors[name]
            record.say(f"{one.channel}, {name}: MAE {factor * a.mae:.3g}, RMSD {factor * a.rmsd:.3g} {unit}{reserved}")
