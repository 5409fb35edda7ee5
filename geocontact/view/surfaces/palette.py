"""Colours of distances: of stills and window, with limits that depend on the thresholds alone, and of the figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.view.curves.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.colors import Colormap

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
