"""A simulated arm and its recording, and the errors of one beside the other by channel and phase."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.analyses.shoulder.recordings import (
    ELEVATION,
    FORCE,
    Channels,
    phase_errors,
    recorded_channels,
    shown_in,
)
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import Agreement
from geocontact.identify.signals.filters import at_times, even_times
from geocontact.io.text.side_table import read_side_table
from geocontact.shoulder_exoskeleton.work_phases import PHASES

SIMULATED = {ELEVATION: "elevation [rad]", FORCE: "supporting [N]"}
"""Columns of the simulated arm that the recorded channels are compared with."""
OUT = "out of the cuff"


@dataclass(frozen=True, eq=False)
class ArmAndRecording:
    """A simulated arm with its phases in words, and the recording.

    Parameters
    ----------
    out_of_cuff
        Share of the simulated time for which the sphere is out of the cuff.
    """

    simulated: Channels
    phase: tuple[str, ...]
    out_of_cuff: float
    recorded: Channels


def read(o: ShoulderCompareOptions) -> ArmAndRecording:
    """Both files."""
    simulated, phase, out = _simulated(o.simulated)
    add_input("simulated", o.simulated, frames=len(phase))
    recorded = recorded_channels(o.recorded, o.map, o.angles, o.unit, o.delay)
    add_input("recorded", o.recorded, samples=len(recorded.time))
    return ArmAndRecording(simulated, phase, out, recorded)


def _simulated(path: Path) -> tuple[Channels, tuple[str, ...], float]:
    needed = ("time [s]", "phase", *SIMULATED.values())
    table = read_side_table(path, (*needed, OUT))
    missing = [name for name in needed if name not in table]
    if missing:
        remedy = "give right.csv or left.csv of shoulder simulate"
        raise InputError(path, "", f"no column {missing[0]}", remedy)
    phase = tuple(map(str, table["phase"]))
    odd = [name for name in phase if name not in PHASES]
    if odd:
        raise InputError(path, "phase", f"{odd[0]!r} is no phase", f"phases are {', '.join(PHASES)}")
    values = {channel: np.asarray(table[name], float) for channel, name in SIMULATED.items()}
    out = float(np.mean([str(each) != "0" for each in table[OUT]])) if OUT in table else 0.0
    return Channels(np.asarray(table["time [s]"], float), values), phase, out


@dataclass(frozen=True, eq=False)
class ComparedChannel:
    """One channel at the simulation's even times [rad or N], and errors by phase."""

    channel: str
    time: Float[np.ndarray, " t"]
    model: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, " t"]
    errors: Mapping[str, Agreement]


def compared(both: ArmAndRecording, o: ShoulderCompareOptions) -> tuple[ComparedChannel, ...]:
    """Every channel that was recorded, over the whole trial, over the work and in each phase."""
    time, step = even_times(both.simulated.time)
    recorded = both.recorded
    inside = (time >= recorded.time[0] - 1e-9) & (time <= recorded.time[-1] + 1e-9)
    if inside.sum() < 2:
        ours, theirs = (f"{each.time[0]:g} to {each.time[-1]:g} s" for each in (both.simulated, recorded))
        raise InputError(o.recorded, "", f"runs from {theirs}, the simulation from {ours}", "give `delay`")
    if not inside.all():
        reserve(f"{o.recorded.name}: {inside.mean():.0%} of the simulated time was recorded")
    phase = np.array(both.phase)
    _, recorded_step = even_times(recorded.time)
    channels = []
    for channel, values in recorded.curves.items():
        measured = at_times(recorded.time, values, time, recorded_step)
        model = both.simulated.curves[channel]
        errors = phase_errors(model, measured, step, phase, inside)
        channels.append(ComparedChannel(channel, time, model, np.where(inside, measured, np.nan), errors))
    return tuple(channels)


def comparison_table(channels: Sequence[ComparedChannel]) -> pd.DataFrame:
    """One row for each channel and part of the trial."""
    rows = []
    for one in channels:
        unit, factor = shown_in(one.channel)
        for phase, a in one.errors.items():
            rows.append(
                {
                    "channel": one.channel,
                    "phase": phase,
                    "unit": unit,
                    "mae": a.mae * factor,
                    "rmsd": a.rmsd * factor,
                    "bias": a.bias * factor,
                    "r2 [-]": a.r2,
                    "lag [s]": a.lag,
                    "samples": a.samples,
                }
            )
    return pd.DataFrame(rows)
