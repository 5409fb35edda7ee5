"""What the colours, lines and lengths of a still mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geocontact.view.surfaces.camera import Shot, View
from geocontact.view.surfaces.palette import DISTANCE_MAP, FAR, MOVING, distance_limits, threshold_colour
from geocontact.view.surfaces.scene import ContactScene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM = 1e3
ROUND = np.array([0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0])  # mm


def annotate(figure: Figure, axes: Axes, scene: ContactScene, view: View, shot: Shot, title: str) -> None:
    """Title, colour bar with the thresholds, legend, scale bar and directions of FIXED's frame."""
    when = {"s": f"t = {scene.time:g} s", "%": f"{scene.time:g} % of the cycle"}.get(
        scene.time_unit, f"{scene.time:g} {scene.time_unit}"
    )
    axes.set_title(", ".join(part for part in (_plain(title), _plain(view.name), when) if part), fontsize=11)
    _colour_bar(figure, axes, scene)
    _legend(figure, scene)
    _scale_bar(axes, shot)
    _directions(figure, shot)


def _plain(text: str) -> str:
    """Text that stays text: a dollar sign would start a formula."""
    return " ".join(text.split()).replace("$", r"\$")


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
