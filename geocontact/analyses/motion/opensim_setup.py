"""OpenSim's set-up files of the tools that `ik`, `id` and `scale` stand for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.io.mocap.markers import read_markers
from geocontact.io.opensim.tool_setup import ToolSetup, read_tool_setup
from geocontact.io.text.tables import read_table

TOOLS = {"ik": "InverseKinematicsTool", "id": "InverseDynamicsTool", "scale": "ScaleTool"}
"""By command."""

Times = Float[np.ndarray, " t"]
Ends = Float[np.ndarray, "2"]


def setup_of(command: str, file: Path) -> ToolSetup:
    """What the set-up asks of the command: its recording, and options as they are typed.

    A range of time begins and ends at the frames that OpenSim 4.6 takes: of coordinates the last ones that are not
    later than its ends, of markers in motion the nearest ones, of a static trial those that enclose it.
    """
    setup = read_tool_setup(file, TOOLS[command])
    taken = {"id": _not_later, "ik": _nearest, "scale": _enclosing}[command]
    options = dict(setup.options)
    files = {"time": setup.recording, "sizes-time": Path(options.get("sizes", setup.recording))}
    kept = ((name, _rows(command, files[name], v, taken) if name in files else v) for name, v in setup.options)
    return replace(setup, options=tuple(kept))


def _rows(command: str, recording: Path, span: str, taken: Callable[[Times, Ends], Int[np.ndarray, 2]]) -> str:
    if not recording.is_file():
        return span  # the command says so
    time = read_table(recording).time if command == "id" else read_markers(recording).time
    ends = np.array([float(end) for end in span.split(":")])
    if ends[0] > time[-1] or ends[1] < time[0]:
        return span  # nothing of the recording is meant
    return ":".join(repr(float(at)) for at in time[taken(time, ends)])


def _not_later(time: Times, ends: Ends) -> Int[np.ndarray, 2]:
    return np.asarray(np.maximum(np.searchsorted(time, ends, side="right") - 1, 0))


def _enclosing(time: Times, ends: Ends) -> Int[np.ndarray, 2]:
    last = np.searchsorted(time, ends[1], side="left")
    return np.array([_not_later(time, ends)[0], np.minimum(last, len(time) - 1)])


def _nearest(time: Times, ends: Ends) -> Int[np.ndarray, 2]:
    return np.asarray(np.abs(time[:, None] - ends).argmin(axis=0))
