"""Distribution of the largest force over a population, and how likely a force is exceeded."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.identify.intervals.quantile_intervals import IntervalEstimate
from geocontact.view.curves.style import BLACK, DOUBLE, PALETTE, in_style, legend, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BINS = 80


@in_style
def population_figure(
    peak: Float[np.ndarray, " n"], levels: Float[np.ndarray, " k"], exceedance: Sequence[IntervalEstimate], limit: float
) -> Figure:
    """Draw finite largest forces [N] on the left, probabilities of passing the levels [N] on the right."""
    figure, (shape, tail) = panels(1, 2, DOUBLE, 0.07)
    counts, edges = np.histogram(peak, BINS, (0.0, float(levels[-1])))
    shape.stairs(counts / (max(len(peak), 1) * np.diff(edges)), edges, color=PALETTE[0], fill=True, alpha=0.5)
    line = shape.axvline(limit, color=BLACK, lw=0.8, ls="--")
    shape.set_xlabel("largest |F| [N]")
    shape.set_ylabel("density [1/N]")
    legend(shape, [(line, f"limit {limit:g} N")])
    value, lower, upper = (np.array([getattr(one, end) for one in exceedance]) for end in ("value", "lower", "upper"))
    band = tail.fill_between(levels, lower, upper, color=PALETTE[0], alpha=0.3, lw=0)
    curve = tail.plot(levels, np.where(value > 0.0, value, np.nan), color=PALETTE[0])[0]
    tail.axvline(limit, color=BLACK, lw=0.8, ls="--")
    tail.set_yscale("log")
    positive = value[value > 0.0]
    tail.set_ylim(0.5 * float(positive.min()) if len(positive) else 1e-6, 1.2)
    tail.set_xlabel("force [N]")
    tail.set_ylabel("probability of more")
    legend(tail, [(curve, "share of the samples"), (band, "95 %, exact")])
    return figure
