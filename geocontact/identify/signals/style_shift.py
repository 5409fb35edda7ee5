"""How far one style's curve is later than another one's, and how much more it swings; intervals over cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

FARTHEST = 25
"""Steps of a curve that it may be later or earlier."""
REPLICATES = 2000
FEWEST = 3
"""Cycles of a style from which an interval is told."""


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
    """Of the style, taken `lag` steps earlier, with the reference where both are known."""
    length = style.shape[1]
    a = style[:, max(lag, 0) : length + min(lag, 0)]
    b = reference[:, max(-lag, 0) : length - max(lag, 0)]
    a, b = a - a.mean(axis=1, keepdims=True), b - b.mean(axis=1, keepdims=True)
    size = np.sqrt(np.square(a).sum(axis=1) * np.square(b).sum(axis=1))
    return np.asarray((a * b).sum(axis=1) / np.where(size > 0.0, size, np.inf))
