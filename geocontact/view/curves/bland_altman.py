"""Bland-Altman plot: how far two methods of measurement agree.

Bland and Altman (1986), "Statistical methods for assessing agreement between two methods of clinical measurement",
The Lancet 327(8476), 307-310, and (1999), "Measuring agreement in method comparison studies", Statistical Methods in
Medical Research 8, 135-160. With differences d = A - B of n independent pairs, their mean m and SD s (n - 1), and t the
97.5 % point of Student's distribution with n - 1 degrees of freedom:

    bias                 m                  95 % confidence interval  m ± t s / sqrt(n)
    limits of agreement  m ± 1.96 s         each                      ± t s sqrt(1/n + 1.96² / (2 (n - 1)))

The paper of 1986 rounds 1.96 to 2 and the variance of a limit to 3 s²/n. Intervals of the limits are approximate: in
200,000 normal samples each they covered 92 % at n = 5, 93 % at 10, 94 % at 20 and 95 % at 60, and nearly all misses
were true limits farther out. Carkeet (2015), Optometry and Vision Science 92(3), e71-e80, has exact ones.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from geocontact.view.curves.quantity import Quantity, array
from geocontact.view.curves.sheet import number
from geocontact.view.curves.style import BLACK, GREY, PALETTE, SMALL, in_style, legend, on

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


Z = 1.96
Interval = tuple[float, float]


@dataclass(frozen=True)
class LimitsOfAgreement:
    """Bias and 95 % limits of agreement with their 95 % confidence intervals, in the unit of the differences."""

    count: int
    bias: float
    sd: float
    lower: float
    upper: float
    bias_interval: Interval
    lower_interval: Interval
    upper_interval: Interval


@dataclass(frozen=True)
class Trend:
    """Straight line of the differences over the means of the pairs, with the 95 % confidence interval of its slope."""

    slope: float
    intercept: float
    slope_interval: Interval


def limits_of_agreement(difference: Float[np.ndarray, " n"]) -> LimitsOfAgreement:
    """Bias and limits of agreement of independent differences; one pair per subject.

    Several pairs per subject need the variance between and within subjects (Bland and Altman 1999, sec. 5), which
    this does not estimate: limits from pooled pairs are too narrow, and so are their intervals.
    """
    n = len(difference)
    bias, sd = float(np.mean(difference)), float(np.std(difference, ddof=1))
    t = float(stdtrit(n - 1, 0.975))
    of_bias = t * sd / np.sqrt(n)
    of_limit = t * sd * np.sqrt(1.0 / n + Z**2 / (2.0 * (n - 1)))
    lower, upper = bias - Z * sd, bias + Z * sd
    return LimitsOfAgreement(
        n,
        bias,
        sd,
        lower,
        upper,
        bias_interval=_around(bias, of_bias),
        lower_interval=_around(lower, of_limit),
        upper_interval=_around(upper, of_limit),
    )


def proportional_bias(mean: Float[np.ndarray, " n"], difference: Float[np.ndarray, " n"]) -> Trend:
    """Least-squares line of difference over mean (Bland and Altman 1999, sec. 3.2).

    A slope also arises without proportional bias where one method scatters more than the other.
    """
    if np.ptp(mean) == 0.0:
        raise ValueError("all means of pairs are equal; a slope over them is not defined")
    (of_mean, both), (_, of_difference) = np.cov(mean, difference, bias=True)
    freedom, slope = len(mean) - 2, float(both / of_mean)
    left = max(float(of_difference - slope * both), 0.0)  # mean square about the line
    half = float(stdtrit(freedom, 0.975)) * np.sqrt(left / of_mean / freedom)
    return Trend(slope, float(difference.mean() - slope * mean.mean()), _around(slope, half))


def _around(centre: float, half: float) -> Interval:
    return float(centre - half), float(centre + half)


LEAST = 3  # pairs
APART = 0.17  # least distance of two notes beside the axes, as a share of its height


@in_style
def bland_altman(
    first: Float[np.ndarray, " n"],
    second: Float[np.ndarray, " n"],
    quantity: Quantity,
    names: tuple[str, str],
    axes: Axes | None = None,
    slope: bool = False,
) -> Figure:
    """Draw differences over means with bias, 95 % limits of agreement and their 95 % confidence intervals.

    Formulas, sources and limits: see `agreement`. Bands are the confidence intervals; numbers in the margin are
    the estimates with these intervals in brackets.

    Parameters
    ----------
    first, second
        One pair per subject, SI units; pairs with a NaN are left out and not counted.
    quantity
        What was measured; its unit is the one of the axes.
    names
        Names of the two methods; the difference is first minus second.
    slope
        Also draw the line of difference over mean, with the 95 % confidence interval of its slope in the legend.
    """
    a, b = array(names[0], first, ("n",)), array(names[1], second, ("n",))
    if len(a) != len(b):
        raise ValueError(f"{names[0]} has {len(a)} values, {names[1]} has {len(b)}; expected pairs")
    there = np.isfinite(a) & np.isfinite(b)
    if there.sum() < LEAST:
        raise ValueError(f"{there.sum()} pairs without NaN, expected at least {LEAST}")
    a, b = quantity.shown(a[there]), quantity.shown(b[there])
    mean, difference = (a + b) / 2.0, a - b
    found = limits_of_agreement(difference)
    figure, axes = on(axes, height=0.065)
    dots = axes.plot(mean, difference, "o", color=PALETTE[0], markersize=3.5, markeredgewidth=0.0, zorder=3)[0]
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = [(dots, f"pairs (n = {found.count})")]
    entries += _lines(axes, found)
    if slope:
        trend = proportional_bias(mean, difference)
        ends = np.array([mean.min(), mean.max()])
        line = axes.plot(ends, trend.intercept + trend.slope * ends, color=PALETTE[1], ls="-.")[0]
        low, high = (number(x, trend.slope) for x in trend.slope_interval)
        entries.append((line, f"slope {number(trend.slope)}, 95 % CI [{low}, {high}]"))
    axes.axhline(0.0, color=GREY, lw=0.5, ls=":", zorder=0)
    axes.set_xlabel(replace(quantity, name=f"mean {quantity.name}").label)
    axes.set_ylabel(replace(quantity, name=f"{names[0]} − {names[1]}").label)
    axes.margins(x=0.06)
    _notes(axes, found)
    legend(axes, entries)
    return figure


def _lines(axes: Axes, found: LimitsOfAgreement) -> list[tuple[Artist | tuple[Artist, ...], str]]:
    rows = (
        (found.bias, found.bias_interval, "-", PALETTE[2]),
        (found.lower, found.lower_interval, "--", BLACK),
        (found.upper, found.upper_interval, "--", BLACK),
    )
    drawn = []
    for value, interval, dashes, colour in rows:
        band = axes.axhspan(*interval, color=colour, alpha=0.15, lw=0, zorder=0)
        drawn.append((band, axes.axhline(value, color=colour, ls=dashes, lw=1.0, zorder=2)))
    return [(drawn[0], "bias, 95 % CI"), (drawn[1], "bias ± 1.96 SD, 95 % CI")]


def _notes(axes: Axes, found: LimitsOfAgreement) -> None:
    """Numbers in the right margin, moved apart where the lines are close."""
    low, high = axes.get_ylim()
    least = APART * (high - low)
    rows = (
        ("bias", found.bias, found.bias_interval, found.bias),
        ("−1.96 SD", found.lower, found.lower_interval, min(found.lower, found.bias - least)),
        ("+1.96 SD", found.upper, found.upper_interval, max(found.upper, found.bias + least)),
    )
    for name, value, interval, height in rows:
        ends = ", ".join(number(x, found.sd) for x in interval)
        axes.text(
            1.02,
            height,
            f"{name}: {number(value, found.sd)}\n[{ends}]",
            transform=axes.get_yaxis_transform(),
            va="center",
            ha="left",
            fontsize=SMALL,
            linespacing=1.1,
        )
