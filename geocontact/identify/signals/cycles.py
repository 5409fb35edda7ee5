"""Cycles of a recording, and how far one style's curve is later than another one's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int

STEPS = np.linspace(0.0, 100.0, 101)
"""Positions in a cycle [%]."""

RELEASE = 0.8
"""A load is gone below this share of the level at which it sets in, so that noise at the level is one crossing."""

SHORTEST = 0.15
"""s; shorter loads, and shorter pauses of a load, are not separated from what is around them."""


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


FARTHEST = 25
"""Steps of a curve that it may be later or earlier."""
REPLICATES = 2000
FEWEST = 3
"""Cycles of a style from which an interval is given."""


@dataclass(frozen=True)
class WithInterval:
    """A number with its interval of 95 %; not a number where there are too few cycles."""

    value: float
    lower: float
    upper: float


@dataclass(frozen=True)
class StyleShift:
    """A style beside a reference.

    Parameters
    ----------
    swing
        Difference of the peak-to-peak amplitudes of both means.
    peak
        Difference of the largest values of both means.
    later
        Steps by which the style is later, at the largest correlation of both means.
    peak_later
        Steps by which its largest value is later.
    correlation
        At that shift.
    """

    swing: WithInterval
    peak: WithInterval
    later: WithInterval
    peak_later: WithInterval
    correlation: float


def style_shift(style: Float[np.ndarray, "c t"], reference: Float[np.ndarray, "d t"], seed: int = 0) -> StyleShift:
    """Curves of both styles, a row per cycle, as long as each other.

    The shift is that at which the part that both means share correlates most, to a fraction of a step by a parabola
    through three correlations, at most 25 steps. Intervals are percentiles over cycles drawn with replacement, of each
    style for itself (Efron and Tibshirani 1993, An Introduction to the Bootstrap, ch. 13).
    """
    rng = np.random.default_rng(seed)
    means = [each.mean(axis=0)[None] for each in (style, reference)]
    drawn = None
    if min(len(style), len(reference)) >= FEWEST:
        drawn = [
            each[rng.integers(len(each), size=(REPLICATES, len(each)))].mean(axis=1) for each in (style, reference)
        ]

    def told(
        number: Callable[[Float[np.ndarray, "b t"], Float[np.ndarray, "b t"]], Float[np.ndarray, " b"]],
    ) -> WithInterval:
        value = float(number(means[0], means[1])[0])
        if drawn is None:
            return WithInterval(value, np.nan, np.nan)
        lower, upper = np.percentile(number(drawn[0], drawn[1]), [2.5, 97.5])
        return WithInterval(value, float(lower), float(upper))

    return StyleShift(
        swing=told(lambda a, b: np.ptp(a, axis=1) - np.ptp(b, axis=1)),
        peak=told(lambda a, b: a.max(axis=1) - b.max(axis=1)),
        later=told(lambda a, b: lag_of(a, b)[0]),
        peak_later=told(lambda a, b: (a.argmax(axis=1) - b.argmax(axis=1)).astype(float)),
        correlation=float(lag_of(means[0], means[1])[1][0]),
    )


def lag_of(
    style: Float[np.ndarray, "b t"], reference: Float[np.ndarray, "b t"]
) -> tuple[Float[np.ndarray, " b"], Float[np.ndarray, " b"]]:
    """Steps by which each row is later than its reference, and the correlation there."""
    lags = np.arange(-FARTHEST, FARTHEST + 1)
    found = np.stack([_correlation(style, reference, int(lag)) for lag in lags], axis=1)
    best = found.argmax(axis=1)
    rows = np.arange(len(style))
    inner = np.clip(best, 1, len(lags) - 2)
    before, here, after = (found[rows, inner + way] for way in (-1, 0, 1))
    bend = before - 2.0 * here + after
    turned = np.where((inner == best) & (bend < 0.0), 0.5 * (before - after) / np.where(bend < 0.0, bend, -1.0), 0.0)
    return lags[best] + turned, found[rows, best]


def _correlation(
    style: Float[np.ndarray, "b t"], reference: Float[np.ndarray, "b t"], lag: int
) -> Float[np.ndarray, " b"]:
    """Correlation of the style, taken `lag` steps earlier, with the reference where both are known."""
    length = style.shape[1]
    a = style[:, max(lag, 0) : length + min(lag, 0)]
    b = reference[:, max(-lag, 0) : length - max(lag, 0)]
    a, b = a - a.mean(axis=1, keepdims=True), b - b.mean(axis=1, keepdims=True)
    size = np.sqrt(np.square(a).sum(axis=1) * np.square(b).sum(axis=1))
    return np.asarray((a * b).sum(axis=1) / np.where(size > 0.0, size, np.inf))
