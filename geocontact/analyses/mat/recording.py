"""What a mat recorded, made ready: read, freed of what an unloaded mat reads, smoothed, flagged."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.mat.dead_cells import treated
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.pressure_frames import PressureFrames
from geocontact.identify.signals.zero_lag import zero_lag
from geocontact.io.mats.catalogue import read_mat
from geocontact.io.mats.layout import read_layout
from geocontact.loads.mat.fill import Hole
from geocontact.loads.mat.offset import Unloaded, unloaded

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
        clipping = self.read.saturated & self.frames.valid
        for hole in self.gaps:
            clipping[:, hole.cell[:, 0], hole.cell[:, 1]] = False
        return np.asarray(clipping)


def read_recording(record: Record, o: MatOptions) -> tuple[PressureFrames, tuple[tuple[int, int], ...]]:
    """The mat that is asked for, and the cells that its layout lists as dead."""
    layout = None if o.layout is None else read_layout(o.layout)
    if o.layout is not None:
        record.add_input("`layout`", o.layout)
    read = _chosen(read_mat(o.frames, layout, o.kind), o)
    record.add_input(
        "frames",
        o.frames,
        mat=read.name,
        rows=read.rows,
        columns=read.columns,
        frames=len(read.time),
        cells=int(read.valid.sum()),
        pitch_mm=[round(p * 1e3, 4) for p in read.pitch],
    )
    return read, layout.dead if layout else ()


def made_ready(
    record: Record, read: PressureFrames, listed: tuple[tuple[int, int], ...], o: MatOptions
) -> PreparedFrames:
    """Frames without offset and dead cells, smoothed; `listed` are the cells that the layout lists as dead."""
    pressure = np.where(read.valid, read.pressure, 0.0)
    if o.unloaded is not None:
        pressure = pressure - _zero(read, pressure, o.unloaded).at(read.time)
    sound = treated(record, read, pressure, listed, o.dead, o.touched)
    pressure, valid = _smooth(read, sound.pressure, o), sound.valid
    frames = replace(read, pressure=np.where(valid, pressure, np.nan), valid=valid)
    found = PreparedFrames(frames, read, sound.gaps)
    _say_what_is_odd(record, found, o)
    return found


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


def _say_what_is_odd(record: Record, seen: PreparedFrames, o: MatOptions) -> None:
    frames, clipping = seen.frames, seen.saturated
    if clipping.any():
        cells, share = int(clipping.any(axis=0).sum()), clipping.any(axis=(1, 2)).mean()
        record.warn(
            f"{cells} cells clip at {frames.saturation * 1e-3:g} kPa, in {share:.0%} of the frames: forces are too low"
        )
    dead = int((~frames.valid).sum())
    if dead:
        record.say(f"{dead} of {frames.valid.size} places of the grid have no working cell")
    silent = frames.valid & ~(frames.pressure > 0.0).any(axis=0)
    if silent.any() and not silent.all():
        record.results["silent_cells"] = np.argwhere(silent).tolist()
    _say_what_is_negative(record, frames)
    force = frames.force
    if o.unloaded is None and force.max(initial=0.0) > 0.0 and force.min() > RESTING * force.max():
        what = f"the mat never reads less than {force.min():.0f} N"
        record.warn(f"{what}: if it was unloaded at some time, say when with `unloaded`")


def _say_what_is_negative(record: Record, frames: PressureFrames) -> None:
    """Noise about zero sums to little; an offset that was taken off and was none does not."""
    pressure = np.where(frames.valid, frames.pressure, 0.0)
    below = np.tensordot(np.minimum(pressure, 0.0), frames.cell_area, 2)
    lowest, least = float(pressure.min(initial=0.0)), float(below.min(initial=0.0))
    record.results["below_zero"] = {"lowest_Pa": lowest, "largest_force_N": -least}
    if -least > RESTING * float(np.abs(frames.force).max(initial=0.0)):
        record.warn(f"cells that read below 0 sum to {least:.1f} N in one frame: check `unloaded` and the offset")
