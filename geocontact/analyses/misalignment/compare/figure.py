"""A model beside recordings, over the angle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.labels import ANGLE
from geocontact.view.curves.quantity import FORCE, Quantity
from geocontact.view.curves.style import DOUBLE, GREY, LINES, MARKERS, PALETTE, in_style, legend, panels
from geocontact.view.curves.text import plain

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

Entries = list[tuple["Artist | tuple[Artist, ...]", str]]


@in_style
def comparison_figure(
    names: Sequence[str],
    beta: Sequence[Float[np.ndarray, " _"]],
    measured: Sequence[Float[np.ndarray, " _"]],
    model: Sequence[Float[np.ndarray, " _"]],
    quantity: Quantity = FORCE,
) -> Figure:
    """Draw one channel over the angle in bins, a colour per trial: measured as marks, the model as lines."""
    figure, (axes,) = panels(1, 1, DOUBLE, 0.08)
    entries: Entries = []
    for k, (name, b, m, s) in enumerate(zip(names, beta, measured, model, strict=True)):
        colour = PALETTE[k % len(PALETTE)]
        dots = axes.plot(np.degrees(b), quantity.shown(m), MARKERS[k % len(MARKERS)], color=colour, markersize=2.5)[0]
        line = axes.plot(np.degrees(b), quantity.shown(s), color=colour, ls=LINES[k % len(LINES)])[0]
        if k < len(PALETTE):
            entries.append(((dots, line), plain(name)))
    axes.axhline(0.0, color=GREY, lw=0.6)
    axes.set_xlabel(ANGLE)
    axes.set_ylabel(quantity.label)
    legend(axes, entries)
    return figure
