"""Where a model misses the measurement: maps over phase and states, and over a mat."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.gap_cells import BAND, FAST, FAST_PHASE, Cell, SurfaceGap
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import DOUBLE, SMALL, empty, in_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage


SIGNIFICANT = 0.05
"""Family-wise: a map without any gap has such a cell once in twenty times."""
BESIDE = 4  # axes of states in one row
ROW = 0.0055  # height of a channel's row [m]
WIDE = ("phase", FAST_PHASE)  # axes with a row of their own
ENERGIES = (BAND, FAST_PHASE)  # axes of what has no sign
MARKS = {1: "+", -1: "−", 0: "•"}  # measured above, below the prediction; no sign
SLENDER = 14  # times as long as it is wide the colour scale is, for each row of strips
ROUNDING = 1e-9  # of the span of an axis that is rounding
LIGHT = 0.55  # of the colour scale, from which marks are white


@in_style
def gap_map_figure(cells: Sequence[Cell], units: Mapping[str, str]) -> Figure:
    """Draw the map as strips, a row per channel, a strip per axis; significant cells carry the sign of the gap.

    The colour is the share of the channel's squared gap along the axis of the strip, noise taken off: the cells of one
    row of one strip sum to 1, or to 0 where there is no gap. States are cut at their quantiles, bands at 1 and 5 Hz.
    What is faster than 5 Hz has a strip of its own over the phase.

    Parameters
    ----------
    cells
        The map.
    units
        Of each axis by its name, as printed.
    """
    if not cells:
        raise ValueError("cells: no map to draw")
    channels = list(dict.fromkeys(cell.channel for cell in cells))
    axes = list(dict.fromkeys(cell.axis for cell in cells))
    wide = [axis for axis in WIDE if axis in axes]
    others = [axis for axis in axes if axis not in WIDE]
    rows = len(wide) + -(-len(others) // BESIDE)
    figure = empty(DOUBLE, rows * (0.022 + ROW * len(channels)))
    grid = figure.add_gridspec(rows, BESIDE)
    places = [grid[k, :] for k in range(len(wide))]
    places += [grid[len(wide) + k // BESIDE, k % BESIDE] for k in range(len(others))]
    strips: list[Axes] = []
    pictures = []
    for k, axis in enumerate([*wide, *others]):
        panel = figure.add_subplot(places[k])
        strips.append(panel)
        pictures.append(_strip(panel, [c for c in cells if c.axis == axis], channels))
        label = f"phase, faster than {FAST:g} Hz" if axis == FAST_PHASE else axis
        panel.set_xlabel(plain(f"{label} [{units[axis]}]" if axis in units else label, 30))
        first = k < len(wide) or (k - len(wide)) % BESIDE == 0
        panel.set_yticks(range(len(channels)), [plain(name, 24) if first else "" for name in channels])
    strips[0].set_ylabel("channel")
    bar = figure.colorbar(pictures[0], ax=strips, shrink=0.8, pad=0.01, aspect=SLENDER * rows)
    bar.set_label("share of the channel's gap [–]")
    note = (
        f"+ / −: measured above / below the prediction, p ≤ {SIGNIFICANT:g} for the whole map; •: an energy, p likewise"
    )
    figure.suptitle(note, fontsize=SMALL, x=0.01, ha="left")
    return figure


def _strip(panel: Axes, cells: Sequence[Cell], channels: Sequence[str]) -> AxesImage:
    lows = sorted({cell.low for cell in cells})
    table = np.full((len(channels), len(lows)), np.nan)
    for cell in cells:
        row, column = channels.index(cell.channel), lows.index(cell.low)
        table[row, column] = cell.share
        if cell.p_value <= SIGNIFICANT:
            sign = 0 if cell.axis in ENERGIES else int(np.sign(cell.gap))
            colour = "white" if cell.share > LIGHT else "black"
            panel.text(column, row, MARKS[sign], ha="center", va="center", fontsize=8.0, color=colour)
    picture = panel.imshow(table, "Blues", vmin=0.0, vmax=1.0, aspect="auto", interpolation="nearest")
    panel.set_facecolor("0.85")
    last = max((cell.high for cell in cells), default=0.0)
    edges = [*lows, last]
    shown = range(0, len(edges), max(1, (len(edges) - 1) // (5 if len(edges) > 10 else 3)))
    span = float(np.ptp([edge for edge in edges if np.isfinite(edge)]))
    panel.set_xticks([k - 0.5 for k in shown], [edge_text(edges[k], span) for k in shown])
    return picture


def edge_text(value: float, span: float) -> str:
    """What is nothing beside the span of all edges is printed as 0."""
    if np.isinf(value):
        return "∞"
    return f"{0.0 if abs(value) < ROUNDING * span else value:.3g}".replace("-", "−")


HEIGHT = 0.070  # [m]
MM = 1e3
FAINT = 0.1  # of the largest part, below which a negative one is not drawn as such
RING = 0.2  # of the area of a cell's marker, so that rings of neighbours stay apart
ON_BLUE = "#d55e00"  # seen on the darkest and the lightest cell
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
        panel.scatter(*at[most].T, s=RING * size, facecolors="none", edgecolors=ON_BLUE, linewidths=0.9)
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
