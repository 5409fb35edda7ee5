"""The mat's recording made ready: frames read, dead cells seen to, motion of the segment that carries it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import add_input, judge, note, reserve, say
from geocontact.analyses.mat.goodness import beyond_saturation, goodness_of_cells, odd_cells, one_top
from geocontact.analyses.mat.options import MatOptions
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import parts, worked
from geocontact.data.pressure_frames import PressureFrames
from geocontact.identify.signals.filters import zero_lag
from geocontact.io.mats.catalogue import read_mat, read_shear_grid
from geocontact.io.mats.layout import read_layout
from geocontact.loads.dead_cells import Hole, dead_cells, filled, holes
from geocontact.loads.mat_load import Unloaded, unloaded
from geocontact.trial_checks.channel_checks import odd_rate

NAMED = 8  # cells in a warning; run.json has them all
MM2 = 1e6

Way = Literal["warn", "mask", "fill"]


@dataclass(frozen=True, eq=False)
class Treated:
    """Pressures after dead cells were seen to.

    Parameters
    ----------
    pressure
        [Pa]
    valid
        Cells that count.
    declared
        Cells that the layout lists as dead.
    gaps
        What was filled; empty unless asked for.
    """

    pressure: Float[np.ndarray, "t r c"]
    valid: Bool[np.ndarray, "r c"]
    declared: Bool[np.ndarray, "r c"]
    gaps: tuple[Hole, ...] = ()

    @property
    def guessed(self) -> Bool[np.ndarray, "r c"]:
        """Cells that were filled."""
        found = np.zeros(self.valid.shape, bool)
        for hole in self.gaps:
            found[hole.cell[:, 0], hole.cell[:, 1]] = True
        return found


def treated(
    read: PressureFrames,
    pressure: Float[np.ndarray, "t r c"],
    declared: tuple[tuple[int, int], ...],
    way: Way,
    touched: float,
) -> Treated:
    """Dead cells by `way`: found in `read`, or `declared` in the layout, which leaves those out of `read` already.

    Only found ones are warned of; declared ones are filled too where that is asked for. `touched` [Pa] is the pressure
    from which a cell counts as loaded.
    """
    found = dead_cells(read, touched)
    listed = np.zeros_like(found)
    for row, column in declared:
        listed[row, column] = True
    if not (found | listed).any():
        return Treated(pressure, read.valid, listed)
    dead = found | listed
    gaps = holes(pressure, read.valid, dead, read.pitch)
    result = _by(way, read, pressure, found, listed, gaps)
    _report_cells(read, pressure, found, result, gaps, way)
    _warn(read, found, result, way)
    return result


def _by(
    way: Way,
    read: PressureFrames,
    pressure: Float[np.ndarray, "t r c"],
    found: Bool[np.ndarray, "r c"],
    listed: Bool[np.ndarray, "r c"],
    gaps: tuple[Hole, ...],
) -> Treated:
    if way == "warn":
        return Treated(pressure, read.valid, listed)
    if way == "mask":
        return Treated(pressure, read.valid & ~found, listed)
    whole = Treated(filled(pressure, gaps), read.valid & ~found, listed, gaps)
    return replace(whole, valid=whole.valid | whole.guessed)


def _report_cells(
    read: PressureFrames,
    pressure: Float[np.ndarray, "t r c"],
    found: Bool[np.ndarray, "r c"],
    result: Treated,
    gaps: tuple[Hole, ...],
    way: Way,
) -> None:
    """run.json has every cell, and what the cells would have carried in the frame with the largest force."""
    whole = filled(pressure, gaps)
    heaviest = int(np.argmax(worked(lambda part: (part * read.cell_area).sum(axis=(1, 2)), whole)))
    dead = np.argwhere(found | result.declared).tolist()
    note(
        "dead_cells",
        {
            "way": way,
            "cells": [
                {
                    "row": r,
                    "column": c,
                    "known_by": "its readings" if found[r, c] else "the layout",
                    "reads_kPa": float(read.pressure[0, r, c]) * 1e-3 if found[r, c] else None,
                    "filled": bool(result.guessed[r, c]),
                }
                for r, c in dead
            ],
            "area_left_out_mm2": float(read.cell_area[(found | result.declared) & ~result.valid].sum()) * MM2,
            "force_by_filling_N": sum(float(whole[heaviest, r, c] * read.cell_area[r, c]) for r, c in dead),
            "force_as_read_N": sum(float(pressure[heaviest, r, c] * read.cell_area[r, c]) for r, c in dead),
            "filling_is_off_by_share": [round(hole.share, 6) for hole in gaps],
        },
    )


def _warn(read: PressureFrames, found: Bool[np.ndarray, "r c"], result: Treated, way: Way) -> None:
    alone = (found | result.declared) & ~result.guessed
    if way == "fill" and alone.any():
        reserve(f"{int(alone.sum())} dead cells have no working neighbour and are left out")
    if not found.any():
        return
    cells = [f"row {r} column {c} ({read.pressure[0, r, c] * 1e-3:g} kPa)" for r, c in np.argwhere(found)]
    named = ", ".join(cells[:NAMED]) + (f" and {len(cells) - NAMED} more" if len(cells) > NAMED else "")
    lost, whole = (float(read.cell_area[which].sum()) * MM2 for which in (found, read.valid))
    done = {
        "warn": "used as they read; `dead` mask leaves them out, `dead` fill takes them from their neighbours",
        "mask": f"left out, {lost:.0f} of {whole:.0f} mm²",
        "fill": "filled from their neighbours",
    }[way]
    reserve(f"cells that never change while those around them do seem dead: {named}; {done}")


UNEVEN = 0.6  # of a step that a frame may come early or late, as clocks are rounded; a lost frame is off by one
RESTING = 0.05  # of the largest force; a mat that never reads less has an offset, or was never unloaded


@dataclass(frozen=True, eq=False)
class PreparedFrames:
    """Frames as they are used, and what was done to them.

    Parameters
    ----------
    frames
        Offset taken off, smoothed. What is below 0 then is noise and stays: cut off, it would no longer average out
        over quiet cells.
    read
        As they were read.
    gaps
        Dead cells that were filled.
    """

    frames: PressureFrames
    read: PressureFrames
    gaps: tuple[Hole, ...]

    @cached_property
    def saturated(self) -> Bool[np.ndarray, "t r c"]:
        """Cells that count and clip, as they were read; filled ones do not."""
        counted = self.frames.valid.copy()
        for hole in self.gaps:
            counted[hole.cell[:, 0], hole.cell[:, 1]] = False
        return worked(lambda part: part & counted, self.read.saturated)


TOUCH = 1e-6  # s; a frame so far beyond the motion is at its end, as times are rounded
SLOWEST = 0.5
"""Hz; mats of seats and beds take 1 to 5 frames in a second, those of walking people 50 and more."""


def read_recording(o: MatOptions) -> tuple[PressureFrames, tuple[tuple[int, int], ...]]:
    """The mat that is asked for, and the cells that its layout lists as dead."""
    layout = None if o.layout is None else read_layout(o.layout)
    if o.layout is not None:
        add_input("`layout`", o.layout)
    read = _chosen(read_mat(o.frames, layout, o.kind), o)
    add_input(
        "frames",
        o.frames,
        mat=read.name,
        rows=read.rows,
        columns=read.columns,
        frames=len(read.time),
        cells=int(read.valid.sum()),
        pitch_mm=[round(p * 1e3, 4) for p in read.pitch],
    )
    for one in odd_rate(str(o.frames), "", read.time, SLOWEST):
        reserve(str(one))
    return read, layout.dead if layout else ()


def made_ready(read: PressureFrames, listed: tuple[tuple[int, int], ...], o: MatOptions) -> PreparedFrames:
    """Frames without offset and dead cells, smoothed; `listed` are the cells that the layout lists as dead."""
    pressure = _working(read, 0.0)
    if o.unloaded is not None:
        offset = _zero(read, pressure, o.unloaded)
        pressure = worked(lambda part, time: part - offset.at(time), pressure, read.time)
    sound = treated(read, pressure, listed, o.dead, o.touched)
    pressure, valid = _smooth(read, sound.pressure, o), sound.valid
    if not valid.all():
        pressure = worked(lambda part: np.where(valid, part, np.nan), pressure)
    found = PreparedFrames(replace(read, pressure=pressure, valid=valid), read, sound.gaps)
    _reserve_oddities(found, o)
    return found


def _working(frames: PressureFrames, other: float) -> Float[np.ndarray, "t r c"]:
    """Pressures, and `other` where there is no cell; no copy where there are cells everywhere."""
    if frames.valid.all():
        return frames.pressure
    return worked(lambda part: np.where(frames.valid, part, other), frames.pressure)


def _chosen(mats: tuple[PressureFrames, ...], o: MatOptions) -> PressureFrames:
    names = [each.name for each in mats]
    if o.sensor is None:
        if len(mats) > 1:
            raise InputError("", "`sensor`", f"the recording holds {len(mats)} mats", f"choose {' or '.join(names)}")
        return mats[0]
    if o.sensor not in names:
        raise InputError("", "`sensor`", f"there is no mat {o.sensor!r}", f"the recording holds {', '.join(names)}")
    return mats[names.index(o.sensor)]


def _zero(
    read: PressureFrames, pressure: Float[np.ndarray, "t r c"], windows: tuple[tuple[float, float], ...]
) -> Unloaded:
    try:
        return unloaded(read.time, pressure, windows)
    except ValueError as error:
        span = f"frames run from {read.time[0]:g} to {read.time[-1]:g} s"
        raise InputError("", "`unloaded`", str(error), span) from error


def _smooth(read: PressureFrames, pressure: Float[np.ndarray, "t r c"], o: MatOptions) -> Float[np.ndarray, "t r c"]:
    if o.cutoff == 0.0:
        return pressure
    if len(read.time) < 2:
        raise InputError("", "`cutoff`", "one frame cannot be filtered", "give `cutoff` 0")
    even = np.linspace(read.time[0], read.time[-1], len(read.time))
    step = float(even[1] - even[0])
    late = np.abs(read.time - even)
    if late.max() > UNEVEN * step:
        at = float(read.time[int(np.argmax(late))])
        what = f"frames are not evenly spaced (up to {late.max():.3g} s off a step of {step:.3g} s, near {at:g} s)"
        raise InputError("", "`cutoff`", what, "give `cutoff` 0")
    try:
        return zero_lag(pressure, step, o.cutoff)
    except ValueError as error:
        raise InputError("", "`cutoff`", str(error), "give a lower one, or 0 for none") from error


def read_shear(recorded: PressureFrames, o: MatOptions) -> tuple[PressureFrames, PressureFrames] | None:
    """Shear stresses of a two-axis mat from row to row and from column to column, without offset, smoothed as the
    pressures are; None without any. InputError for another grid or other times than those of the pressures.
    """
    if o.shear_rows is None or o.shear_columns is None:
        return None
    layout = None if o.layout is None else read_layout(o.layout)
    found: list[PressureFrames] = []
    raw: list[np.ndarray] = []
    for role, file in (("`shear_rows`", o.shear_rows), ("`shear_columns`", o.shear_columns)):
        read = read_shear_grid(file, layout)
        add_input(role, file, frames=len(read.time))
        same = read.pressure.shape == recorded.pressure.shape and np.allclose(read.time, recorded.time, atol=TOUCH)
        if not same or not (read.valid == recorded.valid).all():
            what = f"has other cells or times than {o.frames.name}"
            raise InputError(file, role, what, "export pressure and shear of the same frames")
        for other in [recorded.pressure, *raw]:
            if any(part.any() for (part,) in parts(read.pressure)) and all(
                np.array_equal(one, another, equal_nan=True) for one, another in parts(read.pressure, other)
            ):
                kind = "the pressure" if other is recorded.pressure else "the other shear"
                raise InputError(file, role, f"its values are those of {kind}", "give the files of both shear stresses")
        raw.append(read.pressure)
        stress = _working(read, 0.0)
        if o.unloaded is not None:
            offset = _zero(read, stress, o.unloaded)
            stress = worked(lambda part, time, offset=offset: part - offset.at(time), stress, read.time)
        found.append(replace(read, pressure=_smooth(read, stress, o)))
    return found[0], found[1]


def _reserve_oddities(seen: PreparedFrames, o: MatOptions) -> None:
    frames, clipping = seen.frames, seen.saturated
    judge(goodness_of_cells(frames, clipping), warned=True)
    beyond = list(beyond_saturation(seen.read))
    for line in (*beyond, *odd_cells(seen.read, o.touched, o.gate)):
        reserve(line)
    ever = np.any([part.any(axis=0) for (part,) in parts(clipping)], axis=0)
    if ever.any() and not beyond:
        cells, share = int(ever.sum()), worked(lambda part: part.any(axis=(1, 2)), clipping).mean()
        reserve(
            f"{cells} cells clip at {frames.saturation * 1e-3:g} kPa, in {share:.0%} of the frames: forces are too low"
        )
    for line in one_top(seen.read):
        reserve(line)
    dead = int((~frames.valid).sum())
    if dead:
        say(f"{dead} of {frames.valid.size} places of the grid have no working cell")
    silent = frames.valid & ~np.any([(part > 0.0).any(axis=0) for (part,) in parts(frames.pressure)], axis=0)
    if silent.any() and not silent.all():
        note("silent_cells", np.argwhere(silent).tolist())
    _reserve_negative(frames)
    force = frames.force
    if o.unloaded is None and force.max(initial=0.0) > 0.0 and force.min() > RESTING * force.max():
        what = f"the mat never reads less than {force.min():.0f} N"
        reserve(f"{what}: if it was unloaded at some time, give this time as `unloaded`")


def _reserve_negative(frames: PressureFrames) -> None:
    """Noise about zero sums to little; an offset that was taken off and was none does not."""
    pressure = _working(frames, 0.0)
    below = worked(lambda part: np.tensordot(np.minimum(part, 0.0), frames.cell_area, 2), pressure)
    lowest = min(float(part.min(initial=0.0)) for (part,) in parts(pressure))
    least = float(below.min(initial=0.0))
    note("below_zero", {"lowest_Pa": lowest, "largest_force_N": -least})
    if -least > RESTING * float(np.abs(frames.force).max(initial=0.0)):
        reserve(f"cells that read below 0 sum to {least:.1f} N in one frame: check `unloaded` and the offset")
