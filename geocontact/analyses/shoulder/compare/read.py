"""What a comparison starts from: a simulated arm, and its elevation and force as they were recorded."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.analyses.shoulder.recorded_channels import ELEVATION, FORCE, Channels, recorded_channels
from geocontact.data.errors import InputError
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


def read(o: ShoulderCompareOptions, record: Record) -> ArmAndRecording:
    """Both files."""
    simulated, phase, out = _simulated(o.simulated)
    record.add_input("simulated", o.simulated, frames=len(phase))
    recorded = recorded_channels(o.recorded, o.map, o.angles, o.unit, o.delay)
    record.add_input("recorded", o.recorded, samples=len(recorded.time))
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
