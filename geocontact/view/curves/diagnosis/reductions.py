"""How far the error of each channel shrinks: before and after, with the interval and the noise floor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from geocontact.data.gap.diagnosis import ChannelGap
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, PALETTE, SMALL, empty, in_style
from geocontact.view.curves.text import number, plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROW = 0.022  # height of a channel [m]
HIGH = 0.34  # of a bar, of a channel's height
FAINT = 0.05  # of the error before, below which a floor is not drawn


@in_style
def reductions_figure(gaps: Mapping[str, ChannelGap], quantities: Sequence[Quantity], effect: str = "") -> Figure:
    """Draw the root mean square errors on held-out trials, each channel in per cent of its error before.

    The whisker is the 95 % interval of what stays on fresh trials of the same kind; the dashed line is the noise floor,
    below which no model gets.

    Parameters
    ----------
    gaps
        By channel, SI units.
    quantities
        How each channel is printed, in their order.
    effect
        Name of what was added; "" where nothing was: then there is nothing but the errors before.
    """
    if len(gaps) != len(quantities):
        raise ValueError(f"quantities: {len(quantities)} for {len(gaps)} channels")
    figure = empty(DOUBLE, 0.02 + ROW * len(gaps))
    axes = figure.subplots()
    rows, named = np.arange(len(gaps)), bool(effect)
    for row, (gap, quantity) in enumerate(zip(gaps.values(), quantities, strict=True)):
        whole = gap.rmse_before or 1.0
        told = [("before", row - HIGH / 2.0 if named else float(row), gap.rmse_before, PALETTE[1])]
        told += [("after", row + HIGH / 2.0, gap.rmse_after, PALETTE[0])] if named else []
        for what, place, size, colour in told:
            part, printed = 100.0 * size / whole, number(float(quantity.shown(np.array(size))))
            label = f"with {plain(effect, 40)}" if what == "after" else "base model"
            axes.barh(place, part, height=HIGH, color=colour, label=label if row == 0 else None)
            beside = axes.get_yaxis_transform()
            axes.text(1.01, place, f"{printed} {quantity.unit}", va="center", fontsize=SMALL, transform=beside)
        if named:
            low, high = (100.0 * (1.0 - edge) for edge in reversed(gap.ci95))
            axes.plot([low, high], [row + HIGH / 2.0] * 2, color=BLACK, lw=1.0, marker="|", markersize=6.0)
        floor = 100.0 * gap.noise_floor / whole
        if floor > 100.0 * FAINT:
            line = axes.plot([floor] * 2, [row - HIGH, row + HIGH], color=GREY, ls="--", lw=1.0)[0]
            if row == 0:
                line.set_label("noise floor")
    axes.set_yticks(rows, [plain(name, 24) for name in gaps])
    axes.invert_yaxis()
    axes.set_xlim(0.0, None)
    axes.set_xlabel("error on held-out trials, root mean square [% of the base model's]")
    figure.legend(loc="outside upper left", ncols=3)
    return figure
