"""Columns of tables over time, a panel for each table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.view.curves.quantity import TIME
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import DOUBLE, LINES, PALETTE, in_style, legend, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST = 8  # curves that a legend still names


@in_style
def curves_figure(time: Float[np.ndarray, " t"], tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Each table's columns over time [s] under its axis label; a legend where there are few columns."""
    shown = {label: table for label, table in tables.items() if len(table.columns)}
    figure, column = panels(max(len(shown), 1), 1, DOUBLE, 0.12)
    for axes, (label, table) in zip(column, shown.items(), strict=False):
        drawn = [
            (axes.plot(time, table[name], color=PALETTE[k % len(PALETTE)], ls=LINES[k % len(LINES)])[0], plain(name))
            for k, name in enumerate(map(str, table.columns))
        ]
        axes.set_ylabel(label)
        if len(drawn) <= MOST:
            legend(axes, drawn)
    column[-1].set_xlabel(TIME.label)
    return figure
