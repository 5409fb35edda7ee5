"""Which effects are told apart: nats by which one beats another that is fitted instead."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.view.curves.style import DOUBLE, empty, in_style
from geocontact.view.curves.text import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CELL = 0.0048  # side of a cell [m]
MOST = 20.0  # nats at which the colours end: told apart beyond doubt
FEW = 40  # effects up to which cells carry numbers


@in_style
def separability_figure(true: Sequence[str], imitators: Sequence[str], nats: Float[np.ndarray, "e f"]) -> Figure:
    """Draw the matrix, a row per effect that is there, a column per model that is fitted instead.

    Parameters
    ----------
    true, imitators
        Labels of rows and columns.
    nats
        What the imitator leaves.
    """
    if not len(true):
        raise ValueError("separability: no effect to draw")
    figure = empty(DOUBLE, 0.03 + CELL * len(true))
    axes = figure.subplots()
    picture = axes.imshow(np.clip(nats, 0.0, MOST), vmin=0.0, vmax=MOST, cmap="cividis", aspect="auto")
    axes.set_yticks(range(len(true)), [plain(name, 32) for name in true], fontsize=5.5)
    axes.set_xticks(range(len(imitators)), [plain(name, 32) for name in imitators], rotation=90, fontsize=5.5)
    axes.set_ylabel("effect that is there")
    axes.set_xlabel("model that is fitted instead")
    if len(true) <= FEW:
        for row, col in np.argwhere(nats < MOST):
            shade = "white" if nats[row, col] < 0.6 * MOST else "black"
            axes.text(col, row, f"{max(nats[row, col], 0.0):.0f}", ha="center", va="center", color=shade, fontsize=5.0)
    bar = figure.colorbar(picture, ax=axes, pad=0.01)
    bar.set_label(f"nats by which it is told apart (to {MOST:.0f})")
    return figure
