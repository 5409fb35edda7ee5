"""Path of a contact point or a centre of pressure in a plane."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.view.curves.quantity import LENGTH, TIME, Quantity, array, named, positions
from geocontact.view.curves.style import GREY, INCH, MARKERS, PALETTE, in_style, legend, on

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure

BAR = 0.002  # width of the colour bar [m]
ARROWS = (0.2, 0.5, 0.8)  # shares of the way at which an arrow shows the direction


@in_style
def contact_path(
    time: Float[np.ndarray, " t"],
    paths: Mapping[str, Float[np.ndarray, "t 2"]],
    axes: Axes | None = None,
    outline: Float[np.ndarray, "m 2"] | None = None,
    plane: tuple[str, str] = ("x", "y"),
    along: Quantity = TIME,
) -> Figure:
    """Draw paths with their start, their direction (arrows) and time as colour, to scale.

    Parameters
    ----------
    time
        Time [s] or position in the cycle [%] of each sample; `along` says which.
    paths
        Points in a plane [m] by name ("medial", "lateral"). NaN where there is no contact or where the force is too
        small for a centre of pressure: nothing is drawn there, the gap is not bridged.
    outline
        Contour of the body [m], closed by itself.
    plane
        Names of the two coordinates with their directions, such as ("anterior", "medial").
    """
    t = positions(along, time)
    points = {name: LENGTH.shown(p) for name, p in named("path", paths, (len(t), 2)).items()}
    gone = [name for name, p in points.items() if not np.isfinite(p).all(axis=1).any()]
    if gone:
        raise ValueError(f"path {gone[0]!r}: every sample is NaN")
    border = None if outline is None else LENGTH.shown(array("outline", outline, ("m", 2)))
    figure, axes = on(axes, height=_height([*points.values(), *([] if border is None else [border])]))
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import LineCollection
    from matplotlib.colors import Normalize

    scale = Normalize(float(along.shown(t)[0]), float(along.shown(t)[-1]))
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = []
    if border is not None:
        axes.fill(*border.T, facecolor="0.95", edgecolor=GREY, lw=0.8, zorder=0)
    for k, (name, p) in enumerate(points.items()):
        there = np.isfinite(p).all(axis=1)
        both = there[:-1] & there[1:]
        pieces = np.stack([p[:-1], p[1:]], axis=1)[both]
        lines = LineCollection(list(pieces), cmap=_colours(), norm=scale, linewidths=1.8, capstyle="round")
        lines.set_array(along.shown((t[:-1] + t[1:])[both] / 2.0))
        axes.add_collection(lines)
        alone = there & ~np.r_[both, False] & ~np.r_[False, both]
        axes.scatter(p[alone, 0], p[alone, 1], s=4.0, c=along.shown(t[alone]), cmap=_colours(), norm=scale)
        _arrows(axes, pieces)
        start = axes.plot(
            *p[there][:1].T,
            MARKERS[k],
            color=PALETTE[k],
            markerfacecolor="white",
            markersize=5.0,
            ls="none",
            zorder=5,
        )[0]
        entries.append((start, f"{name}, start"))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.set_xlabel(Quantity(plane[0], LENGTH.unit).label)
    axes.set_ylabel(Quantity(plane[1], LENGTH.unit).label)
    bar = axes.get_window_extent().height / figure.dpi * INCH / BAR
    figure.colorbar(ScalarMappable(scale, _colours()), ax=axes, label=along.label, aspect=bar)
    legend(axes, entries)
    return figure


def _height(shapes: list[np.ndarray]) -> float:
    """Height of a figure of one column's width [m] in which what is drawn to scale leaves little empty."""
    seen = np.concatenate(shapes)
    wide, high = np.nanmax(seen, axis=0) - np.nanmin(seen, axis=0)
    return float(np.clip(0.055 * high / wide if wide > 0.0 else 1.0, 0.03, 0.1)) + 0.02


def _colours() -> Colormap:
    """Cividis without its palest end: distinguished by colour-blind readers, darker to lighter in grey."""
    import matplotlib as mpl
    from matplotlib.colors import ListedColormap

    return ListedColormap(mpl.colormaps["cividis"](np.linspace(0.0, 0.88, 256)), "cividis, dark part")


def _arrows(axes: Axes, pieces: Float[np.ndarray, "s 2 2"]) -> None:
    """Arrow heads along the way, at shares of its length; a path that does not move has none."""
    length = np.linalg.norm(pieces[:, 1] - pieces[:, 0], axis=1)
    if length.sum() == 0.0:
        return
    way = np.cumsum(length)
    for share in ARROWS:
        tail, head = pieces[np.searchsorted(way, share * way[-1])]
        axes.annotate(
            "",
            xy=head,
            xytext=tail,
            zorder=4,
            arrowprops={
                "arrowstyle": "-|>",
                "color": "black",
                "lw": 0.0,
                "mutation_scale": 9.0,
                "shrinkA": 0.0,
                "shrinkB": 0.0,
            },
        )
