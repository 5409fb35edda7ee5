"""Statistics over subjects, arrays in, numbers out: differences along a curve, reliability, curves that lie apart.

*Sign flips* of the subjects' differences show whether two conditions differ somewhere along a curve. Nichols and Holmes
(2002), "Nonparametric permutation tests for functional neuroimaging", Human Brain Mapping 15, 1-25: if the condition
makes no difference, each subject's curve of differences may as well have the other sign. Of all 2^n choices of signs
(or of random ones where there are more) the largest |t| along the curve is kept; the corrected p of a place is the
share of choices whose largest |t| is not below the |t| there. This holds the probability of any false finding along the
whole curve, whatever the correlation of neighbouring places. Needed is that differences are independent between
subjects and spread evenly about their mean.

*Reliability*, the intraclass correlation, is how much of the variance of single measurements is between subjects.
McGraw and Wong (1996), "Forming inferences about some intraclass correlation coefficients", Psychological Methods 1,
30-46 (with the correction of p. 390), two-way model, single measurements: agreement ICC(A,1), in which a bias between
conditions counts as disagreement, and consistency ICC(C,1), in which it does not. These are ICC(2,1) and ICC(3,1) of
Shrout and Fleiss (1979), Psychological Bulletin 86, 420-428. With mean squares of subjects R, conditions C and error E
of n subjects under k conditions:

    ICC(A,1) = (R - E) / (R + (k - 1) E + k (C - E) / n)        ICC(C,1) = (R - E) / (R + (k - 1) E)

*Scores* of trials whose curve lies apart from the others of its condition: the distance of a curve is the root mean
square of what it lies off the median curve of its condition. It is called apart where its modified z score, 0.6745 (d -
median d) / MAD, is above 3.5: Iglewicz and Hoaglin (1993), "How to detect and handle outliers", ASQC Quality Press,
sec. 3.3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import fdtri

LIMIT = 3.5
"""Score from which on a curve lies apart."""
LEAST = 5
"""Trials of a condition: of fewer none can be said to lie apart."""
Interval = tuple[float, float]
MOST_FLIPS = 10_000
AT_ONCE = 512
TIE = 1e-10
"""Relative difference of two values of |t| that are the same but for rounding."""


def scores(curves: Float[np.ndarray, "n t"]) -> Float[np.ndarray, " n"]:
    """Modified z score of each curve's distance; 0 where there are fewer than five, or no curve is off the others."""
    there = np.isfinite(curves).all(axis=1)
    found = np.zeros(len(curves))
    if there.sum() < LEAST:
        return found
    own = curves[there]
    distance = np.sqrt(((own - np.median(own, axis=0)) ** 2).mean(axis=1))
    off = distance - np.median(distance)
    mad = float(np.median(np.abs(off)))
    if mad > 0.0:
        found[there] = 0.6745 * off / mad
    return found


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
    """Reliability over n subjects, each measured once under every one of k conditions; at least two of both, no NaN."""
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
    low, high = ratio / fdtri(n - 1, error, tail), ratio * fdtri(error, n - 1, tail)
    return float((low - 1) / (low + k - 1)), float((high - 1) / (high + k - 1))


def _agreement_interval(n: int, k: int, r: float, c: float, e: float, icc: float, confidence: float) -> Interval:
    """McGraw and Wong, table 7: Satterthwaite's degrees of freedom for the conditions and the error together."""
    a = k * icc / (n * (1.0 - icc))
    b = 1.0 + k * icc * (n - 1) / (n * (1.0 - icc))
    freedom = (a * c + b * e) ** 2 / ((a * c) ** 2 / (k - 1) + (b * e) ** 2 / ((n - 1) * (k - 1)))
    tail = 0.5 + 0.5 * confidence
    low, high = fdtri(n - 1, freedom, tail), fdtri(freedom, n - 1, tail)
    rest = k * c + (k * n - k - n) * e
    return float(n * (r - low * e) / (low * rest + n * r)), float(n * (high * r - e) / (rest + n * high * r))


@dataclass(frozen=True, eq=False)
class SignFlips:
    """Mean difference, t and corrected p along the curve, of how many subjects, with how many choices of signs.

    Parameters
    ----------
    exact
        Whether these were all that there are.
    smallest
        The smallest p that so many subjects can show.
    critical
        |t| from which on p is not above 5 %; infinity where so few subjects cannot show it.
    """

    difference: Float[np.ndarray, " t"]
    t: Float[np.ndarray, " t"]
    p: Float[np.ndarray, " t"]
    subjects: int
    flips: int
    exact: bool
    smallest: float
    critical: float


def sign_flips(differences: Float[np.ndarray, "n t"], seed: int = 0, level: float = 0.05) -> SignFlips:
    """Test of the curves of differences of n subjects, at least two; NaN is not allowed.

    Parameters
    ----------
    differences
        First condition minus second, a row for each subject.
    seed
        Of random signs, where there are more than 10,000 choices.
    level
        Of the critical |t|.
    """
    n = len(differences)
    if n < 2 or not np.isfinite(differences).all():
        raise ValueError(f"{n} subjects, expected at least two and finite differences")
    exact = 2**n <= MOST_FLIPS
    signs = _all_signs(n) if exact else _random_signs(n, seed)
    squares = (differences**2).sum(axis=0)
    largest = np.concatenate(
        [
            np.abs(_t(signs[k : k + AT_ONCE] @ differences / n, squares, n)).max(axis=1)
            for k in range(0, len(signs), AT_ONCE)
        ]
    )
    mean = differences.mean(axis=0)
    t = _t(mean, squares, n)
    least = np.abs(t) * (1.0 - TIE)
    p = (largest[:, None] >= least).mean(axis=0) if len(largest) * len(t) < 1 << 24 else _shares(largest, least)
    return SignFlips(mean, t, p, n, len(signs), exact, (2.0 if exact else 1.0) / len(signs), _critical(largest, level))


def _t(mean: Float[np.ndarray, "*m t"], squares: Float[np.ndarray, " t"], n: int) -> Float[np.ndarray, "*m t"]:
    """Student's t of n differences of this mean and sum of squares; 0 where all are 0."""
    left = np.maximum(squares - n * mean**2, 0.0)
    left = np.where(left <= 1e-14 * squares, 0.0, left)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = mean / np.sqrt(left / (n * (n - 1)))
    return np.where(squares == 0.0, 0.0, t)


def _shares(largest: Float[np.ndarray, " m"], least: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    ordered = np.sort(largest)
    return 1.0 - np.searchsorted(ordered, least, side="left") / len(ordered)


def _critical(largest: Float[np.ndarray, " m"], level: float) -> float:
    """The smallest |t| that no more than a share `level` of the choices reaches."""
    ordered = np.sort(largest)[::-1]
    allowed = int(np.floor(level * len(ordered) + 1e-9))
    return float(ordered[allowed - 1]) if allowed >= 1 and ordered[allowed - 1] > ordered[-1] else float("inf")


def _all_signs(n: int) -> Float[np.ndarray, "m n"]:
    return 1.0 - 2.0 * ((np.arange(2**n)[:, None] >> np.arange(n)) & 1)


def _random_signs(n: int, seed: int) -> Float[np.ndarray, "m n"]:
    """Random choices, the one that was observed first."""
    signs = np.random.default_rng(seed).choice(np.array([-1.0, 1.0]), (MOST_FLIPS, n))
    signs[0] = 1.0
    return signs
