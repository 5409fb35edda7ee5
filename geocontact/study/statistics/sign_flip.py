"""Whether two conditions differ somewhere along a curve: sign flips of the subjects' differences, largest t.

Nichols and Holmes (2002), "Nonparametric permutation tests for functional neuroimaging", Human Brain Mapping 15, 1-25:
if the condition makes no difference, each subject's curve of differences may as well have the other sign. Of all
2^n choices of signs (or of random ones where there are more) the largest |t| along the curve is kept; the corrected p
of a place is the share of choices whose largest |t| is not below the |t| there. This holds the probability of any
false finding along the whole curve, whatever the correlation of neighbouring places. Needed is that differences are
independent between subjects and spread evenly about their mean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

MOST_FLIPS = 10_000
AT_ONCE = 512
TIE = 1e-10
"""Relative difference of two values of |t| that are the same but for rounding."""


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
