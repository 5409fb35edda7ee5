"""What each candidate gains over the base model, and how probable that makes it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from geocontact.data.gap.ranked import Ranked
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, PALETTE, empty, in_style
from geocontact.view.curves.text import number, plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROW = 0.0048  # height of a bar with its distance to the next [m]
MOST = 12  # models drawn


@in_style
def ranking_figure(models: Sequence[Ranked]) -> Figure:
    """Draw the gains as bars, the largest on top, with the probability of each single answer beside its best model."""
    shown = sorted(models, key=lambda one: -one.gain)[:MOST]
    if not shown:
        raise ValueError("models: nothing to rank")
    figure = empty(DOUBLE, 0.014 + ROW * len(shown))
    axes = figure.subplots()
    rows = np.arange(len(shown))
    colours = [PALETTE[2] if one.label == "unknown" else GREY if one.label == "none" else PALETTE[0] for one in shown]
    axes.barh(rows, [one.gain for one in shown], color=colours, height=0.7)
    axes.axvline(0.0, color=BLACK, lw=0.6)
    most = max(abs(one.gain) for one in shown) or 1.0
    for row, one in enumerate(shown):
        text = number(one.gain) if abs(one.gain) < 100.0 else f"{one.gain:.0f}"
        if one.probability is not None and one.probability >= 0.005:
            text += f"  (p = {one.probability:.2f})"
        axes.text(max(one.gain, 0.0) + 0.02 * most, row, text.replace("-", "−"), va="center", fontsize=6.5)
    axes.set_yticks(rows, [plain(one.label, 48) for one in shown])
    axes.set_ylabel("model")
    axes.invert_yaxis()
    axes.set_xlim(min(0.0, *(1.1 * one.gain for one in shown)), 1.3 * most)
    axes.set_xlabel("gain of evidence over the base model [nats]")
    return figure
