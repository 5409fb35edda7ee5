"""Cycles of a recording: where a load sets in and ends, and stretches of time brought to 0 … 100 %."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int

STEPS = np.linspace(0.0, 100.0, 101)
"""Positions in a cycle [%]."""

RELEASE = 0.8
"""A load is gone below this share of the level at which it sets in, so that noise at the level is one crossing."""

SHORTEST = 0.15
"""s; shorter loads, and shorter pauses of a load, are not told apart from what is around them."""


@dataclass(frozen=True)
class Span:
    """A stretch of a recording [s]."""

    start: float
    end: float


def normalised(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], start: float, end: float
) -> Float[np.ndarray, " 101"]:
    """Values at 0, 1, … 100 % of the way from `start` to `end` [s], interpolated linearly.

    Values between a missing sample (NaN) and its neighbours are missing.
    """
    return np.asarray(np.interp(np.minimum(start + (end - start) * STEPS / 100.0, time[-1]), time, values))


def cut(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], starts: Float[np.ndarray, " k"]
) -> Float[np.ndarray, "cycles 101"]:
    """Each cycle at 0, 1, … 100 % of its own duration, interpolated linearly.

    Filter before, not after: interpolation adds nothing to the signal, and peaks between two samples are cut.

    Parameters
    ----------
    time, values
        Recording, strictly increasing in time [s]. Values between a missing sample (NaN) and its neighbours are
        missing.
    starts
        Where cycles begin [s]; the last one ends the last cycle, so k starts make k - 1 cycles. ValueError where they
        do not increase, or lie outside of the recording.
    """
    if not (np.diff(time) > 0.0).all():
        raise ValueError("time: not strictly increasing")
    if len(starts) < 2 or not (np.diff(starts) > 0.0).all():
        raise ValueError(f"starts: {starts}; expected two or more, increasing, the end of the last cycle included")
    if starts[0] < time[0] or starts[-1] > time[-1]:
        said = f"{starts[0]:g} to {starts[-1]:g} s, but the recording has {time[0]:g} to {time[-1]:g} s"
        raise ValueError(f"starts: {said}")
    return np.array([normalised(time, values, begin, end) for begin, end in pairwise(starts.tolist())])


def loaded_spans(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"], level: float) -> list[Span]:
    """From where a load rises through `level` to where it is back below it, complete ones only.

    A load is over when it falls below 0.8 of the level. Pauses and loads shorter than 0.15 s do not count. Times are
    interpolated between samples: where the level itself is crossed.
    """
    state = _on(time, load, level)
    rises, falls = np.flatnonzero(~state[:-1] & state[1:]), np.flatnonzero(state[:-1] & ~state[1:])
    spans = []
    for rise in rises.tolist():
        after = falls[falls > rise]
        if len(after):
            above = np.flatnonzero(load[: int(after[0]) + 1] >= level)
            spans.append(Span(_crossing(time, load, level, rise), _crossing(time, load, level, int(above[-1]))))
    return spans


def strides(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"], level: float) -> list[Span]:
    """From each onset of a load to the next, by `loaded_spans`' rules; the last load need not end."""
    state = _on(time, load, level)
    rises = np.flatnonzero(~state[:-1] & state[1:]).tolist()
    return [Span(*pair) for pair in pairwise(_crossing(time, load, level, rise) for rise in rises)]


def _on(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"], level: float) -> Bool[np.ndarray, " t"]:
    """Whether the load is on: it was last at the level rather than below 0.8 of it, and not just for a moment."""
    decided = np.where(load >= level, 1, np.where(load < RELEASE * level, 0, -1))
    last: Int[np.ndarray, " t"] = np.maximum.accumulate(np.where(decided >= 0, np.arange(len(load)), 0))
    return _without_short(time, _without_short(time, decided[last] == 1, False), True)


def _without_short(time: Float[np.ndarray, " t"], state: Bool[np.ndarray, " t"], value: bool) -> Bool[np.ndarray, " t"]:
    """The same with stretches of `value` shorter than 0.15 s turned over, except at the ends of the recording."""
    out = state.copy()
    changes = np.flatnonzero(np.diff(state.astype(np.int8))) + 1
    for first, last in pairwise(changes.tolist()):
        if state[first] == value and time[last] - time[first] < SHORTEST:
            out[first:last] = not value
    return out


def _crossing(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"], level: float, k: int) -> float:
    """Where the load passes the level between samples k and k + 1 [s]."""
    if load[k] == load[k + 1]:
        return float(time[k])
    share = min(max((level - load[k]) / (load[k + 1] - load[k]), 0.0), 1.0)
    return float(time[k] + share * (time[k + 1] - time[k]))
