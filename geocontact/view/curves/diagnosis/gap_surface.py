"""Where on a mat a channel's gap lies: each cell's part of the load beside its part of the gap."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.gap.surface_gap import SurfaceGap
from geocontact.view.curves.style import DOUBLE, SMALL, empty, in_style
from geocontact.view.curves.text import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 0.070  # [m]
MM = 1e3
FAINT = 0.1  # of the largest part, below which a negative one is not drawn as such
CELL = 110.0  # pt, that all cells of a square mat side by side are drawn as wide


@in_style
def gap_surface_figure(found: SurfaceGap) -> Figure:
    """Two maps of the cells, seen along the direction in which they spread least; cells that hold most are ringed.

    The first is the part of each cell in the force that the base model expects, the second its part in the gap; either
    adds up to 1, and a negative part is off the other way.
    """
    at = flattened(found.place) * MM
    figure = empty(DOUBLE, HEIGHT)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    size = max((CELL / np.sqrt(len(at))) ** 2, 4.0)  # pt², of a marker
    _map(left, at, found.load, size, "part of the load [–]")
    _map(right, at, found.gap, size, f"part of the gap of {found.channel} [–]")
    most = np.isin(found.ids, found.holding)
    for panel in (left, right):
        panel.scatter(at[most, 0], at[most, 1], s=1.6 * size, facecolors="none", edgecolors="black", linewidths=0.8)
        panel.set_xlabel("along the mat [mm]")
        panel.set_aspect("equal")
    left.set_ylabel("across the mat [mm]")
    share, load = (100.0 * part for part in found.held)
    note = (
        f"{plain(found.site, 30)}: ringed cells hold {share:.0f} % of the gap and {load:.0f} % of the load; "
        f"p = {found.p_value:.2g} that it is spread as the load is"
    )
    figure.suptitle(note, fontsize=SMALL, x=0.01, ha="left")
    return figure


def flattened(place: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 2"]:
    """Places along the two directions in which they spread most, the middle at 0."""
    middle = place - place.mean(axis=0)
    axes = np.linalg.svd(middle, full_matrices=False)[2]
    axes = np.vstack([axes, np.zeros((3, 3))])[:2]
    signs = np.sign(axes[np.arange(2), np.abs(axes).argmax(axis=1)])
    return np.asarray(middle @ (axes * np.where(signs == 0.0, 1.0, signs)[:, None]).T)


def _map(panel: Axes, at: Float[np.ndarray, "n 2"], values: Float[np.ndarray, " n"], size: float, label: str) -> None:
    most = float(np.abs(values).max()) or 1.0
    colours = ("RdBu_r", -most) if values.min() < -FAINT * most else ("Blues", 0.0)
    points = panel.scatter(
        at[:, 0], at[:, 1], c=values, s=size, cmap=colours[0], vmin=colours[1], vmax=most, marker="s"
    )
    bar = panel.figure.colorbar(points, ax=panel, shrink=0.85)
    bar.set_label(label)
