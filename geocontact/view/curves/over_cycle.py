"""Area or force over a cycle: mean and standard deviation of the trials."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.trial import mean_and_sd
from geocontact.view.curves.quantity import CYCLE, Quantity, named, positions
from geocontact.view.curves.sheet import FIXED
from geocontact.view.curves.style import LINES, PALETTE, in_style, legend, on

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@in_style
def mean_over_cycle(
    cycle: Float[np.ndarray, " t"],
    groups: Mapping[str, Float[np.ndarray, "_ t"]],
    quantity: Quantity,
    axes: Axes | None = None,
    along: Quantity = CYCLE,
) -> Figure:
    """Draw the mean of each group as a line and mean ± SD over its trials as a band.

    A single trial is drawn without a band. The legend says how many trials there are, "n = 3–5" where some samples
    are missing (NaN). The band is the spread of the trials, not the uncertainty of their mean.

    Parameters
    ----------
    cycle
        Where the samples lie [%], 0 to 100; `identify.signals.cycles.cut` cuts a recording to it.
    groups
        Trials by name of the group, SI units.
    quantity
        What is drawn (AREA, FORCE, …): its unit is the one of the axis.
    axes
        Where to draw; a figure of one column's width is made if not given.
    along
        Name and unit of the horizontal axis: `replace(CYCLE, name="gait cycle")`.

    Returns
    -------
    Figure
        The figure drawn on.
    """
    x = positions(along, cycle)
    trials = named("group", groups, ("trials", len(x)))
    figure, axes = on(axes)
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = []
    for k, (name, values) in enumerate(trials.items()):
        count = np.isfinite(values).sum(axis=0)
        if count.max() == 0:
            raise ValueError(f"group {name!r}: every sample is NaN")
        mean, sd = mean_and_sd(quantity.shown(values))
        line = axes.plot(x, mean, color=PALETTE[k], ls=LINES[k], zorder=3)[0]
        if count.max() > 1:
            band = axes.fill_between(x, mean - sd, mean + sd, color=PALETTE[k], alpha=0.25, lw=0)
            entries.append(((band, line), f"{name}, mean ± SD ({_counted(count)})"))
        else:
            entries.append((line, f"{name} ({_counted(count)})"))
    axes.set_xlim(x[0], x[-1] if len(x) > 1 else None)
    axes.set_xlabel(along.label)
    axes.set_ylabel(quantity.label)
    legend(axes, entries)
    return figure


def _counted(count: np.ndarray) -> str:
    least, most = count.min(), count.max()
    return FIXED.join(("n", "=", f"{most}" if least == most else f"{least}–{most}"))
