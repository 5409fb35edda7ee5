"""Recordings whose angles are simulated along."""

from __future__ import annotations

from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.analyses.run_record import Record
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.io.recordings.elbow_recording import BETA, PRESSURE, TORQUE, read_elbow_recording
from geocontact.io.text.columns import parse_map


def read(o: SimulateOptions, record: Record) -> tuple[ElbowRecording, ...]:
    """The recordings that the options name; their force does not matter."""
    mapping = {} if o.map is None else parse_map(o.map, (BETA, PRESSURE, TORQUE))
    found = []
    for path in o.recordings:
        r = read_elbow_recording(path, mapping, o.angles, needed=())
        record.add_input("angle", path, samples=len(r.time))
        if (o.numbers or {}).get("s", 0.0) != 0.0 and r.pressure is None:
            raise InputError(path, "", "s follows the cuff's pressure, which is not here", "add it, or leave s out")
        found.append(r)
    return tuple(found)
