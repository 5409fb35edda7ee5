"""Recordings beside the markers: elevation of the exoskeleton's arm, force in its cuff, current of the tool."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.marks import AngleUnit, ForceUnit
from geocontact.data.errors import InputError
from geocontact.data.plausible import TOOL
from geocontact.io.recordings.load_cells import column_in_newtons
from geocontact.io.text.columns import angles_of, parse_map, resolve
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.io.text.units import split_header
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.beside_recording import (
    ALONG,
    AROUND,
    FORCES,
    RECORDED,
    SHEAR,
    TANGENTIAL,
    Channels,
)
from geocontact.trial_checks.channel_checks import odd_rate


def shown_in(channel: str) -> tuple[str, float]:
    """Unit of a channel in tables and sentences, and how many of it one SI unit is."""
    return ("N", 1.0) if channel in FORCES else ("deg", float(np.degrees(1.0)))


def recorded_channels(
    path: Path,
    named: str | None = None,
    angles: AngleUnit | None = None,
    unit: ForceUnit | None = None,
    delay: float = 0.0,
) -> Channels:
    """Columns of a table named as `RECORDED`, or those that `named` maps to them; InputError where there is none.

    The size of the shear comes from both of its parts where it is not recorded itself.

    Parameters
    ----------
    angles, unit
        Of columns whose header has no unit.
    delay
        How much the recording's clock is late [s].
    """
    table = read_table(path, leave_words=True)
    if table.time_unit != "s":
        raise InputError(path, "", "time is in per cent of a cycle", "give a recording in seconds")
    mapping = {} if named is None else parse_map(named, RECORDED)
    values = {}
    for channel in RECORDED:
        column = _column(table, channel, mapping)
        if column is not None:
            sign, name = column
            found = _force(table, name, unit) if channel in FORCES else angles_of(table, [name], angles)[:, 0]
            values[channel] = sign * found
    if not values:
        what = f"no column {', '.join(RECORDED[:-1])} or {RECORDED[-1]}; columns are: {listed(table.channels)}"
        raise InputError(path, "", what, "name them: `map` elevation=NAME,force=NAME")
    _require_size(path, values)
    return Channels(table.time - delay, values)


BELOW, ABOVE = -0.02, 1.02
"""Shares of the largest shear that an offset or noise may put a size below 0, or a part above the whole."""


def _require_size(path: Path, values: dict[str, Float[np.ndarray, " t"]]) -> None:
    """The size of the shear from its parts; InputError for a size with a sign, or a part that is larger than it."""
    parts = [values[name] for name in (ALONG, AROUND) if name in values]
    if SHEAR not in values:
        if len(parts) == len(TANGENTIAL) - 1:
            values[SHEAR] = np.hypot(*parts)
        return
    size = values[SHEAR]
    most = float(np.nanmax(np.abs(size), initial=0.0))
    if np.nanmin(size, initial=0.0) < BELOW * most:
        what = f"{SHEAR} is {np.nanmin(size):.3g} N somewhere, and a size is never below 0"
        raise InputError(path, SHEAR, what, f"name a part with a sign: `map` {ALONG}=NAME or {AROUND}=NAME")
    for name in (ALONG, AROUND):
        if name in values and float(np.nanmax(np.abs(values[name]) - size)) > (ABOVE - 1.0) * most:
            what = f"{name} is larger than the shear that it is a part of"
            raise InputError(path, name, what, "check units and columns: shear² = along² + around²")


def _column(table: TextTable, channel: str, mapping: Mapping[str, tuple[float, str]]) -> tuple[float, str] | None:
    sign, name = mapping.get(channel, (1.0, channel))
    if name in table.words:
        raise InputError(
            table.file, "", f"column '{name}' holds words, no {channel}", f"name another: `map` {channel}=NAME"
        )
    found = resolve(table, name)
    if found is None and channel in mapping:
        what = f"no column '{name}' for {channel}; columns are: {listed(table.channels)}"
        raise InputError(table.file, "`map`", what, f"name it: `map` {channel}=NAME")
    return None if found is None else (sign, found)


def _force(table: TextTable, name: str, unit: ForceUnit | None) -> Float[np.ndarray, " t"]:
    return column_in_newtons(table, name, unit)[0]


AXES = "fx", "fy", "fz"
"""Columns of a force on the work."""


def push_force(file: Path, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 3"]:
    """Measured force on the work at these times [N], 0 before and after; InputError where an axis is missing."""
    table = read_table(file, leave_words=True)
    if table.time_unit != "s":
        raise InputError(file, "", "time is in per cent of a cycle", "give a recording in seconds")
    missing = [axis for axis in AXES if resolve(table, axis) is None]
    if missing:
        what = f"no column {missing[0]}; columns are: {listed(table.channels)}"
        raise InputError(file, "", what, "write fx [N], fy [N], fz [N] in the markers' axes")
    add_input("`push`", file, samples=len(table.time))
    columns = [_force(table, str(resolve(table, axis)), None) for axis in AXES]
    return np.column_stack([np.interp(time, table.time, each, 0.0, 0.0) for each in columns])


EVENT, CURRENT = "event", "current"
RUNNING = 4.0
"""Current that an event of 1 stands for [A]; a screwdriver takes as much."""


def tool_runs(file: Path, threshold: float, time: Float[np.ndarray, " t"]) -> Bool[np.ndarray, " t"]:
    """Whether the tool runs at these times [s]; InputError for events that are neither 0 nor 1.

    Parameters
    ----------
    threshold
        Current from which the tool counts as running [A], for a file with a column `current [A]`.
    """
    table, current, binary = _current(file)
    if not binary:
        _doubt_size(file, current)
        _doubt_clock(file, table.time, time)
    on = current > (0.5 if binary else threshold)
    add_input("`tool`", file, samples=len(table.time))
    if not on.any():
        raise InputError(file, "`tool`", "the tool never runs", "give a smaller `tool_current`, or leave it out")
    last = np.clip(np.searchsorted(table.time, time + 1e-9, "right") - 1, 0, len(on) - 1)
    return np.asarray(on[last])


RAISED = np.radians(60.0)
"""Elevation from which an arm does not hang beside a person who stands upright and waits."""
HANGING = 0.2
"""Share of the time that the tool runs, for which no arm is raised, from which its clock is doubted."""


def doubt_tool(file: Path, tool: Bool[np.ndarray, " t"], arms: Sequence[ArmMotion]) -> None:
    """A warning where the tool runs while no arm is raised, in work overhead."""
    raised = np.max([arm.elevation for arm in arms], axis=0) > RAISED
    share = float(np.mean(~raised[tool])) if tool.any() else 0.0
    if share > HANGING and raised.any():
        what = f"it runs while no arm is raised by {np.degrees(RAISED):.0f} degrees for {share:.0%} of the time it runs"
        reserve(f"{file} `tool`: {what}; is its clock that of the markers, and 1 what runs?")


TURNED = 0.3
"""Part of the largest current below 0 that the largest above it is less than, where the sign is turned."""
COVERED = 0.5
"""Share of the markers' time that the tool's recording has to cover."""


def _doubt_size(file: Path, current: Float[np.ndarray, " s"]) -> None:
    if doubt := TOOL.doubt(float(np.nanmax(np.abs(current), initial=0.0))):
        reserve(f"{file} `tool`: {doubt}")


def _doubt_clock(file: Path, own: Float[np.ndarray, " s"], time: Float[np.ndarray, " t"]) -> None:
    """A warning for samples that are too rare or lack, and for a recording of the tool beside that of the markers."""
    for odd in odd_rate(str(file), "", own):
        reserve(str(odd))
    if np.mean((time >= own[0]) & (time <= own[-1])) < COVERED:
        spans = f"runs from {own[0]:.4g} to {own[-1]:.4g} s, the markers from {time[0]:.4g} to {time[-1]:.4g} s"
        reserve(f"{file} `tool`: {spans}: is it of this trial, its time in s, and on the markers' clock?")


def tool_current(file: Path, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Current of the tool at these times [A], as far as the file goes; that of events is 0 or `RUNNING`."""
    table, current, binary = _current(file)
    if not binary:
        _doubt_size(file, current)
        _doubt_clock(file, table.time, time)
    if np.nanmax(current, initial=0.0) < TURNED * -np.nanmin(current, initial=0.0):
        reserve(f"{file} `tool`: its current is down to {np.nanmin(current):.3g} A: is its sign turned?")
    add_input("`tool`", file, samples=len(table.time))
    return np.asarray(np.interp(time, table.time, current))


def current_at(file: Path, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """The same of a file that is an input already."""
    table, current, _ = _current(file)
    return np.asarray(np.interp(time, table.time, current))


def _current(file: Path) -> tuple[TextTable, Float[np.ndarray, " s"], bool]:
    """The table, its current [A], and whether that stands for events of 0 and 1."""
    table = read_table(file, leave_words=True)
    named = {split_header(name)[0]: name for name in table.channels}
    if EVENT in named:
        values = table.column(named[EVENT])
        odd = np.flatnonzero(~np.isin(values, (0.0, 1.0)))
        if len(odd):
            what = f"event is {values[odd[0]]:g} at {table.time[odd[0]]:g} s, neither 0 nor 1"
            raise InputError(file, "", what, "give 1 while the tool runs and 0 else")
        return table, RUNNING * values, True
    if CURRENT in named:
        return table, table.column(named[CURRENT]), False
    what = f"no column event or current; columns are: {listed(table.channels)}"
    raise InputError(file, "", what, "name it event [-] or current [A]")
