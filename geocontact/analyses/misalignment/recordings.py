"""Recordings of the elbow as the options name them: read, filtered, and held against each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.bins import FORCE, Binned
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.signals.even_times import at_times, even_times
from geocontact.identify.signals.zero_lag import zero_lag
from geocontact.io.recordings import elbow_recording as channels
from geocontact.io.recordings.elbow_recording import read_elbow_recording
from geocontact.io.text.columns import parse_map

LEAST_BINS = 8  # that a fit is made to
SLID = 0.5e-3  # m; a locked joint does not move as far
MIRRORED = -0.5  # correlation of a trial with the others from which on its sign is turned


def recordings(
    record: Record,
    role: str,
    paths: Sequence[Path],
    mapping: str | None,
    angles: Literal["deg", "rad"] | None,
    unit: str | None,
    cutoff: float | None,
    needed: tuple[str, ...] = (channels.FORCE,),
) -> list[ElbowRecording]:
    """The recordings of one role; they need names of their own."""
    columns = {} if mapping is None else parse_map(mapping, channels.CHANNELS)
    found: list[ElbowRecording] = []
    for path in paths:
        if path.stem in [r.name for r in found]:
            raise InputError(path, "", f"is the second recording named {path.stem!r}", "rename one")
        raw = read_elbow_recording(path, columns, angles, unit, needed)
        record.add_input(role, path, samples=len(raw.time))
        found.append(raw if cutoff is None else _filtered(path, raw, cutoff))
    return found


def _filtered(path: Path, r: ElbowRecording, cutoff: float) -> ElbowRecording:
    """Angle, force and displacement without what lies above the cut-off, at even times."""
    time, step = even_times(r.time)

    def smooth(values: np.ndarray) -> np.ndarray:
        even = at_times(r.time, values, time, step)
        if np.isnan(even).any():
            raise InputError(path, "", "has gaps that a filter cannot cross", "cut it, or leave --cutoff out")
        try:
            return zero_lag(even, step, cutoff)
        except ValueError as error:
            raise InputError(path, "", str(error), "give another --cutoff") from error

    return replace(
        r,
        time=time,
        beta=smooth(r.beta),
        force=smooth(r.force),
        displacement=None if r.displacement is None else smooth(r.displacement),
        pressure=None if r.pressure is None else at_times(r.time, r.pressure, time, step),
    )


def require_locked(paths: Sequence[Path], found: Sequence[ElbowRecording]) -> None:
    """Refuse recordings whose compensation joint slides among the locked ones."""
    for path, r in zip(paths, found, strict=True):
        moved = 0.0 if r.displacement is None else float(np.ptp(r.displacement))
        if moved > SLID:
            what = f"the compensation joint slides by {moved * 1e3:.1f} mm in it"
            raise InputError(path, "", what, "give it with --unlocked, or map another column: --map displacement=…")


def require_bins(record: Record, paths: Sequence[Path], data: Binned) -> None:
    """Refuse too few bins, name those that are missing inside the range reached, and a trial of the other sign."""
    bins = len(data.visits.edges) - 1
    reached = np.bincount(data.cells.place, minlength=bins) > 0
    if reached.sum() < LEAST_BINS:
        span = np.degrees(data.visits.edges[[0, -1]])
        what = f"{reached.sum()} bins are reached between {span[0]:.0f} and {span[1]:.0f} degrees"
        raise InputError(paths[0], "", what, f"{LEAST_BINS} are needed: give narrower bins (--bin-deg) or wider motion")
    inside = np.flatnonzero(reached)[[0, -1]]
    missing = np.flatnonzero(~reached[: inside[1]])
    missing = missing[missing > inside[0]]
    if len(missing):
        runs = np.split(missing, np.flatnonzero(np.diff(missing) > 1) + 1)
        edges = np.degrees(data.visits.edges)
        told = ", ".join(f"{edges[run[0]]:.0f}…{edges[run[-1] + 1]:.0f}°" for run in runs)
        record.warn(f"no sample in {len(missing)} bins inside the range reached: {told}")
    _refuse_mirrored(paths, data)


def _refuse_mirrored(paths: Sequence[Path], data: Binned) -> None:
    """A trial whose force mirrors that of the others."""
    for trial, path in enumerate(paths):
        if len(paths) < 2:
            return
        mine, others = data.only(trial).cells, data.without(trial).cells
        bins = len(data.visits.edges) - 1
        count = np.bincount(others.place, others.count, bins)
        mean = np.bincount(others.place, others.count * others.means[:, FORCE], bins) / np.where(count > 0, count, 1)
        both = count[mine.place] > 0
        if both.sum() < LEAST_BINS:
            continue
        correlation = float(np.corrcoef(mine.means[both, FORCE], mean[mine.place][both])[0, 1])
        if correlation < MIRRORED:
            others_are = "the other trial, and nothing tells which is right" if len(paths) == 2 else "the other trials"
            what = f"its force mirrors that of {others_are} (correlation {correlation:.2f} over the bins)"
            raise InputError(path, "", what, "is its sign turned? correct the file, or leave it out")
