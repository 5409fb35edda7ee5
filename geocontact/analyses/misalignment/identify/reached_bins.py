"""Bins that recordings reach: enough of them, and trials that agree on the sign of the force."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.bins import FORCE, Binned
from geocontact.data.errors import InputError

ROUNDING = 1e-9  # of the force's range; less is no noise
LEAST_BINS = 8  # that a fit is made to
MIRRORED = -0.5  # correlation of a trial with the others from which on its sign is turned


def require_bins(record: Record, paths: Sequence[Path], data: Binned) -> None:
    """Refuse too few bins, name those that are missing inside the range reached, and a trial of the other sign."""
    bins = len(data.visits.edges) - 1
    reached = np.bincount(data.cells.place, minlength=bins) > 0
    if reached.sum() < LEAST_BINS:
        span = np.degrees(data.visits.edges[[0, -1]])
        what = f"{reached.sum()} bins are reached between {span[0]:.0f} and {span[1]:.0f} degrees"
        raise InputError(paths[0], "", what, f"{LEAST_BINS} are needed: give narrower bins (`bin`) or wider motion")
    _require_noise(paths[0], data)
    inside = np.flatnonzero(reached)[[0, -1]]
    missing = np.flatnonzero(~reached[: inside[1]])
    missing = missing[missing > inside[0]]
    if len(missing):
        runs = np.split(missing, np.flatnonzero(np.diff(missing) > 1) + 1)
        edges = np.degrees(data.visits.edges)
        told = ", ".join(f"{edges[run[0]]:.0f}…{edges[run[-1] + 1]:.0f}°" for run in runs)
        record.warn(f"no sample in {len(missing)} bins inside the range reached: {told}")
    _refuse_mirrored(paths, data)


def _require_noise(path: Path, data: Binned) -> None:
    """Refuse recordings whose samples all lie on the curve through their bins, as one sample in each bin does."""
    noise, force = float(data.noise.sd[0]), data.cells.means[:, FORCE]
    if not noise > ROUNDING * float(np.ptp(force)):
        what = f"{data.cells.count.sum():.0f} samples in {len(np.unique(data.cells.place))} bins show no noise"
        raise InputError(path, "", what, "give longer recordings or wider bins (`bin`): intervals come from it")


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
