"""From which size on effects are seen, as a share of what is plausible."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, empty, in_style
from geocontact.view.curves.text import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROW = 0.0042  # height of a bar with its distance to the next [m]
LEAST = 1e-4  # share of the shortest bars
WORDS = 0.3  # of the width of the longest bar, for the words beside it


@dataclass(frozen=True)
class EffectVisibility:
    """One effect: its label, the share of the plausible range from which it is seen (None: never), words beside it."""

    label: str
    share: float | None
    words: str


@in_style
def detectability_figure(effects: Sequence[EffectVisibility]) -> Figure:
    """Draw a bar per effect up to the smallest amplitude that is seen, the most easily seen on top."""
    if not effects:
        raise ValueError("detectability: no effect to draw")
    shown = sorted(effects, key=lambda one: np.inf if one.share is None else one.share)
    figure = empty(DOUBLE, 0.014 + ROW * len(shown))
    axes = figure.subplots()
    rows = np.arange(len(shown))
    widths = [1.0 if one.share is None else max(one.share, LEAST) for one in shown]
    colours = [GREY if one.share is None else PALETTE[0] for one in shown]
    axes.barh(rows, widths, color=colours, height=0.7)
    for row, (one, width) in enumerate(zip(shown, widths, strict=True)):
        axes.text(1.15 * width, row, plain(one.words, 60), va="center", fontsize=6.0)
    axes.set_xscale("log")
    axes.set_xlim(0.5 * LEAST, max(widths) * (2.0 * max(widths) / LEAST) ** WORDS)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_yticks(rows, [plain(one.label, 40) for one in shown], fontsize=6.0)
    axes.set_xlabel("smallest amplitude that is seen, share of the plausible range [–]")
    return figure
