"""Are residuals normal? Histogram and quantile-quantile plot.

The band is the tail-sensitive one of Aldor-Noiman, Brown, Buja, Rolke and Stine (2013), "The Power to See: A New
Graphical Test of Normality", The American Statistician 67(4), 249-260: each order statistic of a uniform sample is
beta-distributed, and the pointwise level is lowered until all n points lie within with the probability asked for.
Here the simulated samples are standardised by their own mean and SD, as the drawn line is, so that the level holds
where both are estimated. It holds for independent samples only: neighbours in a time series are not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int
from scipy.special import betainc, betaincc, betaincinv, ndtr, ndtri

from geocontact.view.curves.quantity import Quantity, finite
from geocontact.view.curves.sheet import number, plain
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, PALETTE, in_style, legend, on, panels

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


SIMULATED = 2000  # samples; the level of a 95 % band is then known to ± 0.5 % (one standard error)
RANKS = 400  # of a large sample that are simulated; between them the band follows the same formula


@dataclass(frozen=True)
class NormalQuantiles:
    """Sorted sample beside the quantiles of the standard normal distribution.

    theoretical
        Medians of the standard normal order statistics.
    ordered
        Sample, sorted.
    lower, upper
        Band around `mean` + `sd` × `theoretical`, simultaneous over all points.
    p
        Share of normal samples whose worst point is at least as far out as the worst one here.
    """

    theoretical: Float[np.ndarray, " n"]
    ordered: Float[np.ndarray, " n"]
    lower: Float[np.ndarray, " n"]
    upper: Float[np.ndarray, " n"]
    mean: float
    sd: float
    p: float


def normal_quantiles(sample: Float[np.ndarray, " n"], level: float = 0.95) -> NormalQuantiles:
    """Compare a sample with the normal distribution of its own mean and SD (n - 1).

    The simulation has a fixed seed: the same number of values gives the same band.
    """
    n = len(sample)
    mean, sd = float(np.mean(sample)), float(np.std(sample, ddof=1))
    if sd <= 1e-12 * abs(mean):
        raise ValueError(f"residual: all {n} values are {mean:g}; a constant has no distribution to compare")
    ordered, rank = np.sort(sample), np.arange(1, n + 1)
    worst = _worst_of_normal_samples(n)
    depth = float(np.quantile(worst, 1.0 - level))
    found = _depth((ordered - mean) / sd, rank, n).min()
    lowest = np.asarray(ndtri(betaincinv(rank, n + 1 - rank, depth / 2.0)))
    return NormalQuantiles(
        theoretical=np.asarray(ndtri(betaincinv(rank, n + 1 - rank, 0.5))),
        ordered=ordered,
        lower=mean + sd * lowest,
        upper=mean - sd * lowest[::-1],
        mean=mean,
        sd=sd,
        p=float((1 + np.sum(worst <= found)) / (1 + SIMULATED)),
    )


def _depth(standardised: Float[np.ndarray, "*s r"], rank: Int[np.ndarray, " r"], n: int) -> Float[np.ndarray, "*s r"]:
    """Two-sided p-value of each order statistic of n."""
    below = betainc(rank, n + 1 - rank, ndtr(standardised))
    above = betaincc(rank, n + 1 - rank, ndtr(standardised))
    return np.asarray(2.0 * np.minimum(below, above))


@lru_cache(maxsize=16)
def _worst_of_normal_samples(n: int) -> Float[np.ndarray, " simulated"]:
    """Smallest p-value over the order statistics of each of many normal samples."""
    rng = np.random.default_rng(20130667)
    tail = np.unique(np.geomspace(1, (n + 1) // 2, min(n, RANKS // 2)).astype(int))
    rank = np.unique(np.r_[tail, n + 1 - tail]) if n > RANKS else np.arange(1, n + 1)
    worst = np.empty(SIMULATED)
    for k in range(SIMULATED):
        drawn = np.sort(rng.standard_normal(n))
        worst[k] = _depth((drawn[rank - 1] - drawn.mean()) / drawn.std(ddof=1), rank, n).min()
    return worst


LEAST = 3  # values below which neither an SD nor a distribution can be seen


@in_style
def residual_histogram(residual: Float[np.ndarray, " n"], quantity: Quantity, axes: Axes | None = None) -> Figure:
    """Draw residuals as a density beside the normal density of the same mean and SD (n - 1).

    Bins are as wide as Scott (1979) makes them for normal samples, 3.49 SD n^(-1/3). NaN is left out and not counted.

    Parameters
    ----------
    residual
        Measured minus simulated, SI units.
    quantity
        What was measured; its unit is the one of the axis.
    """
    values = quantity.shown(finite("residual", residual, LEAST))
    mean, sd = float(values.mean()), float(values.std(ddof=1))
    figure, axes = on(axes)
    edges = np.histogram_bin_edges(values, "scott")
    density = np.histogram(values, edges, density=True)[0]
    bars = axes.bar(edges[:-1], density, np.diff(edges), align="edge", color=PALETTE[0], alpha=0.45, edgecolor="white")
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = [(bars.patches[0], f"residual (n = {len(values)})")]
    if sd > 0.0:
        x = np.linspace(min(edges[0], mean - 3.5 * sd), max(edges[-1], mean + 3.5 * sd), 301)
        curve = axes.plot(x, np.exp(-0.5 * ((x - mean) / sd) ** 2) / (np.sqrt(2.0 * np.pi) * sd), color=BLACK)[0]
        entries.append((curve, f"normal, mean {number(mean, sd)}, SD {number(sd)} {quantity.unit}"))
    axes.axvline(0.0, color=GREY, lw=0.6, zorder=0)
    axes.set_xlabel(_residual(quantity).label)
    axes.set_ylabel(f"density [1/{plain(quantity.unit)}]")
    legend(axes, entries)
    return figure


@in_style
def residual_quantiles(
    residual: Float[np.ndarray, " n"], quantity: Quantity, axes: Axes | None = None, told: str | None = None
) -> Figure:
    """Draw ordered residuals against normal quantiles, with a band that holds 95 % of normal samples entirely.

    The band is simultaneous (Aldor-Noiman et al. 2013, see `normal_band`): one point outside is evidence at 5 %
    against normal residuals, and p in the legend is the p-value of that test. Both suppose independent residuals;
    those of a time series follow each other, and a p-value from them is too small.

    Parameters
    ----------
    residual
        Measured minus simulated, SI units; NaN is left out.
    quantity
        What was measured; its unit is the one of the axis.
    told
        Test and p-value that stand in the legend where another test than the band's is reported.
    """
    q = normal_quantiles(quantity.shown(finite("residual", residual, LEAST)))
    figure, axes = on(axes)
    band = axes.fill_between(q.theoretical, q.lower, q.upper, color=GREY, alpha=0.3, lw=0)
    line = axes.plot(q.theoretical, q.mean + q.sd * q.theoretical, color=BLACK, lw=0.8)[0]
    dots = axes.plot(q.theoretical, q.ordered, "o", color=PALETTE[0], markersize=2.5, markeredgewidth=0.0)[0]
    axes.set_xlabel("standard normal quantile [–]")
    axes.set_ylabel(_residual(quantity).label)
    p = "p < 0.001" if q.p < 1e-3 else f"p = {q.p:.3f}" if q.p < 0.1 else f"p = {q.p:.2f}"
    legend(
        axes,
        [
            (dots, f"residual (n = {len(q.ordered)})"),
            (line, "mean + SD × quantile"),
            (band, f"95 % simultaneous band, {p if told is None else told}"),
        ],
    )
    return figure


@in_style
def residual_figure(residual: Float[np.ndarray, " n"], quantity: Quantity) -> Figure:
    """Histogram (a) and quantile-quantile plot (b) side by side, two columns wide."""
    figure, (left, right) = panels(1, 2, DOUBLE, 0.07)
    residual_histogram(residual, quantity, left)
    residual_quantiles(residual, quantity, right)
    return figure


def _residual(quantity: Quantity) -> Quantity:
    return replace(quantity, name=f"residual {quantity.name}")
