"""The static figures of load cells: cells and compartments over time, and the mean of the compartments over a cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.identify.signals.cycles import STEPS, Span
from geocontact.identify.signals.gaps import broken
from geocontact.view.curves.over_cycle import mean_over_cycle
from geocontact.view.curves.quantity import CYCLE, FORCE, TIME, Quantity
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, legend, panels
from geocontact.view.curves.text import plain
from geocontact.view.extremes import thinned_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@in_style
def loadcell_figure(
    time: Float[np.ndarray, " t"],
    cells: Mapping[str, Float[np.ndarray, " t"]],
    sides: Mapping[str, Float[np.ndarray, " t"]],
    spans: tuple[Span, ...] = (),
) -> Figure:
    """Forces of the cells above, those of the compartments below [N]; cycles are shaded in turns."""
    figure, (above, below) = panels(2, 1, DOUBLE, 0.12)
    for axes, curves in ((above, cells), (below, sides)):
        _lines(axes, time, curves)
        for k, span in enumerate(spans):
            axes.axvspan(span.start, span.end, color=GREY, alpha=0.12 if k % 2 else 0.2, lw=0, zorder=0)
    above.set_ylabel("force of a cell [N]")
    below.set_ylabel(FORCE.label)
    below.set_xlabel(TIME.label)
    return figure


def _lines(axes: Axes, time: Float[np.ndarray, " t"], curves: Mapping[str, Float[np.ndarray, " t"]]) -> None:
    drawn = [
        (
            axes.plot(*thinned_line(*broken(time, values)), color=PALETTE[k % len(PALETTE)], ls=LINES[k % len(LINES)])[
                0
            ],
            plain(name),
        )
        for k, (name, values) in enumerate(curves.items())
    ]
    axes.set_xlim(time[0], time[-1])
    axes.axhline(0.0, color=GREY, lw=0.6, zorder=1)
    legend(axes, drawn)


CYCLES = 8
"""Single cycles of a style that are drawn at most: more lines tell no more, and a file must not grow with them."""


def some_cycles(trials: Float[np.ndarray, "n t"]) -> Float[np.ndarray, "k t"]:
    """All cycles, or `CYCLES` of them: the one with the highest peak, the one with the lowest, and others between."""
    if len(trials) <= CYCLES:
        return trials
    by_peak = np.argsort(trials.max(axis=1), kind="stable")
    return np.asarray(trials[np.sort(by_peak[np.linspace(0, len(trials) - 1, CYCLES).astype(int)])])


@in_style
def ensemble_figure(
    sides: Mapping[str, Mapping[str, Float[np.ndarray, "_ 101"]]],
    along: str = "cycle",
    unit: str = "N",
    per_newton: float = 1.0,
) -> Figure:
    """Mean and SD over the cycle and, thin, single cycles; a panel per compartment, a colour per gait style.

    Forces are shown in `unit`, of which one newton is `per_newton`.
    """
    figure, row = panels(1, len(sides), DOUBLE, 0.07)
    for axes, (side, styles) in zip(row, sides.items(), strict=True):
        shown = Quantity(f"{side} contact force", unit, per_newton)
        mean_over_cycle(STEPS, styles, shown, axes, replace(CYCLE, name=along))
        for k, trials in enumerate(styles.values()):
            if len(trials) > 1:
                axes.plot(STEPS, shown.shown(some_cycles(trials)).T, color=PALETTE[k], lw=0.5, alpha=0.6, zorder=2)
    return figure
