"""Are residuals normal? Histogram and quantile-quantile plot."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.stats import norm

from geocontact.view.curves.given import finite
from geocontact.view.curves.normal_band import normal_quantiles
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, PALETTE, in_style, legend, on, panels
from geocontact.view.curves.text import number, plain

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
        curve = axes.plot(x, norm.pdf(x, mean, sd), color=BLACK)[0]
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
