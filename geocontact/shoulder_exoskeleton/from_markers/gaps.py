"""Frames in which markers were not seen."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.errors import InputError


def seen_span(seen: Bool[np.ndarray, " t"]) -> slice:
    """Frames from the first to the last that is seen; empty where none is."""
    frames = np.flatnonzero(seen)
    return slice(int(frames[0]), int(frames[-1]) + 1) if len(frames) else slice(0, 0)


def longest_gap(time: Float[np.ndarray, " t"], seen: Bool[np.ndarray, " t"]) -> tuple[float, float]:
    """Times of the frames seen last before and first after the longest gap [s]; equal where there is none.

    ValueError where the first or the last frame is not seen: that is no gap, nothing lies beyond it.
    """
    if not (len(seen) and seen[0] and seen[-1]):
        raise ValueError("the first and the last frame must be seen")
    there = time[seen]
    steps = np.diff(np.flatnonzero(seen))
    lengths = np.where(steps > 1, np.diff(there), 0.0)
    if not len(lengths) or lengths.max() == 0.0:
        return float(time[0]), float(time[0])
    longest = int(np.argmax(lengths))
    return float(there[longest]), float(there[longest + 1])


def require_short_gaps(
    name: str, time: Float[np.ndarray, " t"], seen: Bool[np.ndarray, " t"], limit: float, source: str
) -> None:
    """InputError where a gap is longer than a limit [s]."""
    start, stop = longest_gap(time, seen)
    if stop - start > limit:
        what = f"{name} is not seen from {start:.2f} to {stop:.2f} s, {stop - start:.2g} s; the limit is {limit:g} s"
        raise InputError(source, "", what, "fill the gap, cut the trial with `time`, or raise `gap_limit`")
