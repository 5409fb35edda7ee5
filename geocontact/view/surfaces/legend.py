"""What the colours, lines and lengths of a still mean: palette, lines of equal distance, legend."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import COLOURS
from geocontact.view.surfaces.camera import Shot, View
from geocontact.view.surfaces.scene import ContactScene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure


def level_lines(
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    values: Float[np.ndarray, " n"],
    level: float,
) -> tuple[Float[np.ndarray, "s 2 3"], Int[np.ndarray, " s"]]:
    """Segments along which linearly interpolated `values` equal `level`, and the face that each lies in.

    A value equal to the level counts as below it, as in the area. Faces with a corner of infinite value have no line.
    """
    crossed = np.isfinite(values[faces]).all(axis=1)
    below = values[faces] <= level
    crossed &= below.any(axis=1) & ~below.all(axis=1)
    index = np.flatnonzero(crossed)
    corners, below = faces[index], below[index]
    odd = np.where(below.sum(axis=1) == 1, below.argmax(axis=1), (~below).argmax(axis=1))  # the corner on its own side
    rows = np.arange(len(index))
    alone = corners[rows, odd]
    ends = []
    for step in (1, 2):
        other = corners[rows, (odd + step) % 3]
        share = (level - values[alone]) / (values[other] - values[alone])
        ends.append(vertices[alone] + share[:, None] * (vertices[other] - vertices[alone]))
    return np.stack(ends, axis=1), index


DISTANCE_MAP = "viridis_r"  # perceptually uniform; bright is close
FAR = "#D9D9D9"  # beyond what was asked for
MOVING = "#7F97B2"


OVERLAP = ("#6a040f", "#b3261e", "#e8590c", "#ff9a3c")
"""Deep to shallow, as on the page."""


def distance_colours(lower: float, upper: float) -> Colormap:
    """Colours of distances between two limits as the page has them: `DISTANCE_MAP` from 0 on, `OVERLAP` below."""
    from matplotlib import colormaps
    from matplotlib.colors import LinearSegmentedColormap, ListedColormap

    levels = np.linspace(lower, upper, 512)
    near = np.clip((levels - max(lower, 0.0)) / (upper - max(lower, 0.0)), 0.0, 1.0)
    colours = colormaps[DISTANCE_MAP](near)
    if lower < 0.0:
        below = levels < 0.0
        colours[below] = LinearSegmentedColormap.from_list("overlap", OVERLAP)(1.0 - levels[below] / lower)
    return ListedColormap(colours)


def distance_limits(thresholds: tuple[float, ...]) -> tuple[float, float]:
    """Lower and upper end of the colour map [m]: the same in every frame, so that pictures can be compared."""
    span = max(2.0 * max(thresholds), 1e-3)
    return -span / 4.0, span


def threshold_colour(k: int) -> str:
    """Colour of the line of threshold `k`."""
    return COLOURS[k % len(COLOURS)]


def known_up_to(distance: Float[np.ndarray, "*t n"], faces: Int[np.ndarray, "m 3"]) -> float:
    """Largest level [m] below which the distance is known all over each face that it reaches; infinite if everywhere.

    Distances end at an infinite value in the middle of a mesh; a picture that ends at this level has a clean edge there
    instead of one that follows the triangles. Every threshold that was asked for lies below it.
    """
    corners = distance[..., faces]
    unknown = corners == np.inf
    cut = unknown.any(axis=-1, keepdims=True) & ~unknown
    return float(corners[cut].min(initial=np.inf))


def coloured(
    distance: Float[np.ndarray, " n"], thresholds: tuple[float, ...], known: float
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "1024 3"], tuple[float, float]]:
    """Finite values [m], colours (red, green, blue in 0 to 1) and the range of values [m] that they cover.

    The colours of `DISTANCE_MAP` up to `known`, then `FAR`.
    """
    from matplotlib import colormaps
    from matplotlib.colors import to_rgb

    lower, upper = distance_limits(thresholds)
    top = 2.0 * (min(known, upper) - lower) + lower if known < upper else upper
    levels = np.linspace(lower, top, 1024)
    colours = colormaps[DISTANCE_MAP]((levels - lower) / (upper - lower))[:, :3]
    colours[levels >= known] = to_rgb(FAR)
    return np.clip(distance, lower, top), colours, (lower, top)


MM = 1e3
WIDEST_TITLE = 62
"""Characters of a line above a picture."""
ROUND = np.array([0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0])  # mm


def annotate(figure: Figure, axes: Axes, scene: ContactScene, view: View, shot: Shot, title: str) -> None:
    """Title, colour bar with the thresholds, legend, scale bar and directions of FIXED's frame."""
    when = {"s": f"t = {scene.time:g} s", "%": f"{scene.time:g} % of the cycle"}.get(
        scene.time_unit, f"{scene.time:g} {scene.time_unit}"
    )
    figure.suptitle(plain(", ".join(part for part in (title, view.name, when) if part), WIDEST_TITLE), fontsize=11)
    _colour_bar(figure, axes, scene)
    _legend(figure, scene)
    _scale_bar(axes, shot)
    _directions(figure, shot)


def _colour_bar(figure: Figure, axes: Axes, scene: ContactScene) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    lower, upper = (limit * MM for limit in distance_limits(scene.thresholds))
    colours = ScalarMappable(Normalize(lower, upper), DISTANCE_MAP)
    kind = "signed distance" if scene.signed else "distance"
    bar = figure.colorbar(colours, ax=axes, shrink=0.7, aspect=28, pad=0.02, label=f"{kind} of FIXED to MOVING [mm]")
    for k, threshold in enumerate(scene.thresholds):
        bar.ax.axhline(threshold * MM, color="white", lw=3.6)
        bar.ax.axhline(threshold * MM, color=threshold_colour(k), lw=1.8)


def _legend(figure: Figure, scene: ContactScene) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    lines = [Line2D([], [], color=threshold_colour(k), lw=2.0) for k in range(len(scene.thresholds))]
    labels = [f"{threshold * MM:g} mm" for threshold in scene.thresholds]
    bodies = [Patch(facecolor=FAR), Patch(facecolor=(*_rgb(MOVING), 0.2), edgecolor=MOVING)]
    figure.legend(
        [*lines, *bodies],
        [*labels, "FIXED, farther away", "MOVING"],
        loc="outside lower center",
        ncols=6,
        fontsize=9,
        frameon=False,
        handlelength=1.6,
    )


def _rgb(colour: str) -> tuple[float, float, float]:
    from matplotlib.colors import to_rgb

    return to_rgb(colour)


def _scale_bar(axes: Axes, shot: Shot) -> None:
    width, height = shot.half[:2] * MM
    length = float(ROUND[max(int(np.searchsorted(ROUND, 0.4 * width)) - 1, 0)])
    right, below = width, -height - 0.02 * height
    axes.plot([right - length, right], [below, below], color="black", lw=2.0, clip_on=False, solid_capstyle="butt")
    axes.text(right - 0.5 * length, below - 0.03 * height, f"{length:g} mm", ha="center", va="top", fontsize=9)


def _directions(figure: Figure, shot: Shot) -> None:
    """FIXED's axes as they look from here, in the lower left corner; one along the view is left out."""
    axes = figure.add_axes((0.01, 0.01, 0.125, 0.125 * figure.get_figwidth() / figure.get_figheight()))
    axes.set_in_layout(False)
    axes.set_xlim(-1.0, 1.0)
    axes.set_ylim(-1.0, 1.0)
    axes.set_axis_off()
    seen = [k for k in range(3) if np.linalg.norm(shot.axes[:2, k]) > 0.15]
    right, up = 0.6 * shot.axes[0, seen], 0.6 * shot.axes[1, seen]
    origin = np.zeros(len(seen))
    axes.quiver(origin, origin, right, up, angles="xy", scale_units="xy", scale=1.0, color="0.3", width=0.03)
    for k in seen:
        arrow = shot.axes[:2, k]
        x, y = 0.6 * arrow + 0.25 * arrow / np.linalg.norm(arrow)
        axes.text(x, y, "xyz"[k], ha="center", va="center", fontsize=9, color="0.3")
