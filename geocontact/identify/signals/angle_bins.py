"""Recordings sorted by angle: what was measured in each bin, stretch of time by stretch of time.

A stretch is so long that what remains of a model's residual in two of them has little in common; so the stretches, not
the samples, are what a test or an interval counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

LEAST_SECONDS = 0.02
"""A bin in which a trial spent less time is not counted as reached by it."""


@dataclass(frozen=True, eq=False)
class AngleBins:
    """Means of the channels over the samples of one trial, stretch and bin.

    Parameters
    ----------
    edges
        Of the bins [rad], over the range reached.
    trial, stretch, place
        Of each visit: which trial, which stretch (counted through all trials), which bin.
    count
        Samples.
    means
        Of each channel over them; the first channel is the one that is binned.
    """

    edges: Float[np.ndarray, " edges"]
    trial: Int[np.ndarray, " v"]
    stretch: Int[np.ndarray, " v"]
    place: Int[np.ndarray, " v"]
    count: Float[np.ndarray, " v"]
    means: Float[np.ndarray, "v c"]

    def cells(self) -> Cells:
        """All visits of a trial to a bin taken together."""
        bins = len(self.edges) - 1
        key = self.trial * bins + self.place
        there, cell = np.unique(key, return_inverse=True)
        count = np.bincount(cell, self.count)
        sums = np.column_stack([np.bincount(cell, self.count * column) for column in self.means.T])
        return Cells(there // bins, there % bins, count, sums / count[:, None], cell)


@dataclass(frozen=True, eq=False)
class Cells:
    """Means of the channels of a trial in a bin; `of_visit` says which cell each visit is a part of."""

    trial: Int[np.ndarray, " n"]
    place: Int[np.ndarray, " n"]
    count: Float[np.ndarray, " n"]
    means: Float[np.ndarray, "n c"]
    of_visit: Int[np.ndarray, " v"]


def edges_over(angles: Sequence[Float[np.ndarray, " _"]], width: float) -> Float[np.ndarray, " edges"]:
    """Edges of bins of `width` [rad] at its multiples, over the range that is reached and no farther."""
    low, high = min(float(a.min()) for a in angles), max(float(a.max()) for a in angles)
    first, last = int(np.floor(low / width)), int(np.floor(high / width)) + 1
    return width * np.arange(first, last + 1)


def bin_numbers(angle: Float[np.ndarray, " t"], edges: Float[np.ndarray, " edges"]) -> Int[np.ndarray, " t"]:
    """Bin of each sample, the last one's upper edge included."""
    return np.clip(np.searchsorted(edges, angle, side="right") - 1, 0, len(edges) - 2)


def angle_bins(
    times: Sequence[Float[np.ndarray, " _"]],
    channels: Sequence[Float[np.ndarray, "_ c"]],
    edges: Float[np.ndarray, " edges"],
    stretch: float,
) -> AngleBins:
    """Visits of several trials; the first channel is binned, a stretch is `stretch` [s] long."""
    parts, first = [], 0
    bins = len(edges) - 1
    for trial, (time, values) in enumerate(zip(times, channels, strict=True)):
        place = bin_numbers(values[:, 0], edges)
        number = np.floor((time - time[0]) / stretch).astype(int)
        key = number * bins + place
        count = np.bincount(key)
        there = np.flatnonzero(count)
        sums = np.column_stack([np.bincount(key, column)[there] for column in values.T])
        step = float(np.median(np.diff(time)))
        enough = np.bincount(place, minlength=bins) * step >= LEAST_SECONDS
        kept = enough[there % bins]
        cell = there[kept]
        means = sums[kept] / count[cell, None]
        parts.append((np.full(len(cell), trial), first + cell // bins, cell % bins, count[cell].astype(float), means))
        first += int(number[-1]) + 1
    trial_of, stretch_of, place_of, count_of, means_of = (np.concatenate(p) for p in zip(*parts, strict=True))
    return AngleBins(edges, trial_of, stretch_of, place_of, count_of, means_of)
