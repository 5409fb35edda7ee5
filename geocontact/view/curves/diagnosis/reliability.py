"""What stated probabilities came to, beside the line where they would be true."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.view.curves.style import GREY, MARKERS, PALETTE, SINGLE, empty, in_style, legend

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Stated:
    """Stated probabilities in bins.

    Parameters
    ----------
    stated, came_true
        Mean of each bin, and the share that came true.
    low, high
        Interval of that share.
    count
        How many.
    """

    stated: Float[np.ndarray, " b"]
    came_true: Float[np.ndarray, " b"]
    low: Float[np.ndarray, " b"]
    high: Float[np.ndarray, " b"]
    count: Sequence[int]


@in_style
def reliability_figure(answerers: Mapping[str, Stated]) -> Figure:
    """Draw came true over stated; the first of several carries its counts, the others stand a little to the right."""
    if not answerers:
        raise ValueError("answerers: nobody stated anything")
    figure = empty(SINGLE, SINGLE)
    axes = figure.subplots()
    axes.plot([0.0, 1.0], [0.0, 1.0], color=GREY, lw=0.6)
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = []
    for k, (name, one) in enumerate(answerers.items()):
        reach = np.clip([one.came_true - one.low, one.high - one.came_true], 0.0, None)
        place, width = one.stated + 0.012 * k, 0.8 if k == 0 else 0.5
        drawn = axes.errorbar(
            place, one.came_true, reach, elinewidth=0.6, lw=width, ms=3.5, color=PALETTE[k], marker=MARKERS[k]
        )
        entries.append((drawn[0], name))
        for x, y, n in zip(place, one.came_true, one.count, strict=True):
            if k == 0:
                axes.annotate(str(n), (x, y), (3, 3), textcoords="offset points", fontsize=6.0, color=PALETTE[0])
    axes.set(xlim=(-0.02, 1.05), ylim=(-0.02, 1.06), xlabel="probability stated", ylabel="share that came true")
    legend(axes, entries)
    return figure
