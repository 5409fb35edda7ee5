"""Intraclass correlation: how much of the variance of single measurements is between subjects.

McGraw and Wong (1996), "Forming inferences about some intraclass correlation coefficients", Psychological Methods 1,
30-46 (with the correction of p. 390), two-way model, single measurements: agreement ICC(A,1), in which a bias between
conditions counts as disagreement, and consistency ICC(C,1), in which it does not. These are ICC(2,1) and ICC(3,1) of
Shrout and Fleiss (1979), Psychological Bulletin 86, 420-428. With mean squares of subjects R, conditions C and
error E of n subjects under k conditions:

    ICC(A,1) = (R - E) / (R + (k - 1) E + k (C - E) / n)        ICC(C,1) = (R - E) / (R + (k - 1) E)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import f as fisher

Interval = tuple[float, float]


@dataclass(frozen=True)
class Reliability:
    """Both coefficients with their 95 % confidence intervals; NaN where all measurements are equal."""

    subjects: int
    conditions: int
    agreement: float
    agreement_interval: Interval
    consistency: float
    consistency_interval: Interval


def reliability(values: Float[np.ndarray, "n k"], confidence: float = 0.95) -> Reliability:
    """Of n subjects, each measured once under every one of k conditions; at least two of both, no NaN."""
    n, k = values.shape
    if n < 2 or k < 2 or not np.isfinite(values).all():
        raise ValueError(f"{n} subjects under {k} conditions, expected at least two of both and finite values")
    grand = values.mean()
    rows, columns = values.mean(axis=1), values.mean(axis=0)
    of_rows = k * ((rows - grand) ** 2).sum() / (n - 1)
    of_columns = n * ((columns - grand) ** 2).sum() / (k - 1)
    error = ((values - rows[:, None] - columns + grand) ** 2).sum() / ((n - 1) * (k - 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        agreement = (of_rows - error) / (of_rows + (k - 1) * error + k * (of_columns - error) / n)
        consistency = (of_rows - error) / (of_rows + (k - 1) * error)
        of_agreement = _agreement_interval(n, k, of_rows, of_columns, error, agreement, confidence)
        of_consistency = _consistency_interval(n, k, of_rows / error, confidence)
    return Reliability(n, k, float(agreement), of_agreement, float(consistency), of_consistency)


def _consistency_interval(n: int, k: int, ratio: float, confidence: float) -> Interval:
    """McGraw and Wong, table 7: from F = R / E."""
    tail, error = 0.5 + 0.5 * confidence, (n - 1) * (k - 1)
    low, high = ratio / fisher.ppf(tail, n - 1, error), ratio * fisher.ppf(tail, error, n - 1)
    return float((low - 1) / (low + k - 1)), float((high - 1) / (high + k - 1))


def _agreement_interval(n: int, k: int, r: float, c: float, e: float, icc: float, confidence: float) -> Interval:
    """McGraw and Wong, table 7: Satterthwaite's degrees of freedom for the conditions and the error together."""
    a = k * icc / (n * (1.0 - icc))
    b = 1.0 + k * icc * (n - 1) / (n * (1.0 - icc))
    freedom = (a * c + b * e) ** 2 / ((a * c) ** 2 / (k - 1) + (b * e) ** 2 / ((n - 1) * (k - 1)))
    tail = 0.5 + 0.5 * confidence
    low, high = fisher.ppf(tail, n - 1, freedom), fisher.ppf(tail, freedom, n - 1)
    rest = k * c + (k * n - k - n) * e
    return float(n * (r - low * e) / (low * rest + n * r)), float(n * (high * r - e) / (rest + n * high * r))
