"""Do bins differ, are residuals normal: tests that count what is independent, and what a p-value of theirs says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.identify.signals.angle_bins import AngleBins

LEVEL = 0.05
FEWEST = 3  # visits of a bin that is compared
DRAWS = 1999


@dataclass(frozen=True)
class BinTest:
    """Kruskal-Wallis test of a channel between bins.

    Parameters
    ----------
    statistic, p
        H, and the probability of one as large where the bins do not differ.
    bins, counted, samples
        Bins compared; visits that count as independent values; samples that they were averaged from.
    """

    statistic: float
    p: float
    bins: int
    counted: int
    samples: int


@dataclass(frozen=True)
class Normality:
    """Lilliefors' test: the distance of the distribution from the normal one of its own mean and SD, and its p-value.

    A small p is evidence against normal residuals; a large one is no evidence for them, only none against.
    """

    distance: float
    p: float
    count: int

    @property
    def words(self) -> str:
        """What the p-value says."""
        test = f"{self.shown}, by simulated normal noise with the memory of the recorded one"
        if self.p < LEVEL:
            return f"not normal: Lilliefors' test rejects it ({test}; a small p speaks against)"
        return f"no evidence against normal residuals (Lilliefors, {test}; this does not prove them)"

    @property
    def shown(self) -> str:
        """The p-value in print."""
        return "p < 0.001" if self.p < 1e-3 else f"p = {self.p:.3f}"


def between_bins(v: AngleBins, channel: int) -> BinTest | None:
    """Kruskal-Wallis test of one channel's visit means between bins; None where fewer than two bins have enough.

    Samples of a recording follow each other, and a test that counts each of them finds anything. A visit (one stretch
    of time in one bin) counts once. Bins share stretches, which makes them more alike than independent ones: p errs on
    the side of no difference.
    """
    from scipy.stats import kruskal

    places = [place for place in np.unique(v.place) if (v.place == place).sum() >= FEWEST]
    if len(places) < 2:
        return None
    groups = [v.means[v.place == place, channel] for place in places]
    found = kruskal(*groups)
    used = np.isin(v.place, places)
    return BinTest(
        float(found.statistic), float(found.pvalue), len(places), int(used.sum()), round(float(v.count[used].sum()))
    )


@dataclass(frozen=True)
class BinPair:
    """Mann-Whitney test of a channel between two bins, by their places, and its p after Holm's correction."""

    places: tuple[int, int]
    statistic: float
    p: float
    p_holm: float


def between_neighbours(v: AngleBins, channel: int) -> list[BinPair]:
    """Mann-Whitney test of each bin against the next one, over visit means as `between_bins`.

    Which bins differ, where the omnibus test says only that some do. Holm (1979), Scandinavian Journal of Statistics 6,
    65, keeps the probability of one false difference among all pairs below the level. Bins with fewer than three visits
    are left out, and so are pairs across a gap.
    """
    from scipy.stats import mannwhitneyu

    groups = {int(place): v.means[v.place == place, channel] for place in np.unique(v.place)}
    pairs = [(k, k + 1) for k in groups if min(len(groups[k]), len(groups.get(k + 1, ()))) >= FEWEST]
    tests = [mannwhitneyu(groups[a], groups[b]) for a, b in pairs]
    corrected = holm(np.array([float(test.pvalue) for test in tests]))
    found = zip(pairs, tests, corrected, strict=True)
    return [BinPair(pair, float(test.statistic), float(test.pvalue), float(p)) for pair, test, p in found]


def holm(p: Float[np.ndarray, " m"]) -> Float[np.ndarray, " m"]:
    """Adjusted p-values: the smallest times m, the next times m - 1, never falling, 1 at most."""
    order = np.argsort(p)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum(np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1)), 1.0)
    return adjusted


def lilliefors(residual: Float[np.ndarray, " n"], null: Float[np.ndarray, "d n"]) -> Normality:
    """Lilliefors (1967), JASA 62, 399, of values that need not be independent.

    Parameters
    ----------
    null
        Draws of what the values would be if they were normal, with the correlations that they have; p is the share of
        draws as far from their own normal distribution, 1/(d + 1) at least.
    """
    distance = _from_normal(residual[None])[0]
    beyond = int((_from_normal(null) >= distance).sum())
    return Normality(float(distance), (1 + beyond) / (1 + len(null)), len(residual))


def _from_normal(rows: Float[np.ndarray, "d n"]) -> Float[np.ndarray, " d"]:
    """Largest distance of each row's distribution from the normal one of its mean and SD."""
    from scipy.special import ndtr

    n = rows.shape[1]
    below = ndtr(np.sort((rows - rows.mean(axis=1, keepdims=True)) / rows.std(axis=1, ddof=1, keepdims=True)))
    return np.asarray(np.maximum(np.arange(1, n + 1) / n - below, below - np.arange(n) / n).max(axis=1))
