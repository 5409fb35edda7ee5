"""What the squared error of each channel consists of, as stacked bars before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from geocontact.view.curves.sheet import number, plain
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, SMALL, empty, in_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.011
"""Height of a bar with its distance to the next [m]."""
COLOURS = {
    "sensor": GREY,
    "inputs": PALETTE[4],
    "variation": PALETTE[5],
    "effects": PALETTE[0],
    "unexplained": PALETTE[1],
}
"""Colour of each part, in the order in which a bar is stacked."""
DARK, LIGHT_INK = ("sensor", "effects", "unexplained"), "#fefefe"
"""Parts too dark for black figures, and the colour of theirs, which a page leaves as it is in the dark."""


@dataclass(frozen=True)
class BudgetBar:
    """A channel before or after.

    Parameters
    ----------
    label
        Beside the bar.
    parts
        Share of the squared error before [-], by part; negative ones are not drawn.
    size
        Root mean square error, with its unit.
    """

    label: str
    parts: Mapping[str, float]
    size: str


@in_style
def error_budget_figure(bars: Sequence[BudgetBar], words: Mapping[str, str]) -> Figure:
    """Draw a stacked bar for each channel before, and after where something is named; `words` are those of parts."""
    if not bars:
        raise ValueError("bars: no channel has an error")
    figure = empty(DOUBLE, 0.024 + HEIGHT * len(bars))
    axes = figure.subplots()
    for row, bar in enumerate(bars):
        left = 0.0
        for part, colour in COLOURS.items():
            width = 100.0 * max(bar.parts.get(part, 0.0), 0.0)
            axes.barh(row, width, left=left, height=0.7, color=colour, label=words[part] if row == 0 else None)
            if width > 6.0:
                ink = LIGHT_INK if part in DARK else "black"
                axes.text(
                    left + width / 2, row, number(width, 100.0), ha="center", va="center", fontsize=SMALL, color=ink
                )
            left += width
        beside = axes.get_yaxis_transform()
        axes.text(1.01, row, bar.size, va="center", fontsize=SMALL, transform=beside)
    axes.set_yticks(range(len(bars)), [plain(bar.label, 40) for bar in bars])
    axes.invert_yaxis()
    axes.set_xlim(0.0, None)
    axes.set_xlabel("squared error on held-out trials [% of the base model's]")
    figure.legend(loc="outside upper left", ncols=3)
    return figure
