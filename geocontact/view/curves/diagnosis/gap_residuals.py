"""What the base model leaves over on held-out trials, and what is left with the effects that were named."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, SMALL, empty, in_style
from geocontact.view.curves.text import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PHASE = Quantity("phase of the trial", "%")
Z95 = 1.959964


@in_style
def gap_residuals(
    phase: Float[np.ndarray, " t"],
    channels: Sequence[Quantity],
    base: Float[np.ndarray, "trials t c"],
    named: Float[np.ndarray, "trials t c"] | None,
    floor: Mapping[str, float],
    windows: Mapping[str, tuple[float, float]],
    effect: str = "",
) -> Figure:
    """Draw residuals of each trial, a panel per channel; the band is what noise alone would make, the grey window the
    stretch that holds 70 % of the channel's gap.

    Parameters
    ----------
    phase
        Fraction of the trial.
    channels
        Name and unit of each, in the order of the columns.
    base, named
        Measured minus predicted, SI units, without and with the effects; None where nothing was named.
    floor
        Root mean square of what no model can predict, by channel; the band is ± 1.96 of it.
    windows
        By channel, fractions of the trial; none where there is no gap.
    effect
        What was named, for the legend.
    """
    if base.shape[1:] != (len(phase), len(channels)):
        raise ValueError(f"base: shape {base.shape}, expected (trials, {len(phase)}, {len(channels)})")
    figure = empty(DOUBLE, 0.012 + 0.032 * len(channels))
    panels = figure.subplots(len(channels), 1, sharex=True, squeeze=False)[:, 0]
    handles, labels = [], []
    for c, (panel, quantity) in enumerate(zip(panels, channels, strict=True)):
        if quantity.name in windows:
            low, high = windows[quantity.name]
            panel.axvspan(100.0 * low, 100.0 * high, color="0.9", lw=0, zorder=0)
        noise = float(quantity.shown(np.array(Z95 * floor.get(quantity.name, 0.0))))
        band = panel.axhspan(-noise, noise, color=PALETTE[0], alpha=0.15, lw=0, zorder=1)
        panel.axhline(0.0, color=GREY, lw=0.6)
        without = panel.plot(100.0 * phase, quantity.shown(base[:, :, c]).T, color=PALETTE[1], lw=0.8)
        entries = [(without[0], "base model"), (band, "± 1.96 noise floor")]
        if named is not None:
            having = panel.plot(100.0 * phase, quantity.shown(named[:, :, c]).T, color=PALETTE[0], lw=0.8)
            entries.insert(1, (having[0], f"with {effect}"))
        panel.set_ylabel(plain(f"{quantity.name}, measured − predicted [{quantity.unit}]", 22), fontsize=SMALL)
        handles, labels = [e[0] for e in entries], [plain(e[1], 80) for e in entries]
    panels[0].set_xlim(0.0, 100.0)
    panels[-1].set_xlabel(PHASE.label)
    figure.legend(handles, labels, loc="outside upper left", ncols=3)
    return figure
