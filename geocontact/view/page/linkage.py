"""Points and lines over time: a skeleton, markers, forces, the floor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float, Int, UInt16

from geocontact.view.page.pack import GRID, Grid

Tone = Literal["bone", "seen", "model", "force", "floor"]
MISSING = GRID
"""Word of a coordinate of a point that is not known; those of known points are below."""


@dataclass(frozen=True, eq=False)
class Linkage:
    """Points, and lines between some of them.

    Parameters
    ----------
    name
        Any text; it stays text.
    points
        In the scene's frame S [m], one row for each frame, or one row for all; NaN where a point is not known.
    lines
        Pairs of points; a line is drawn where both are known.
    tone
        Its colour by what it is.
    radius
        Of the points [m]; 0 draws lines only.
    width
        Thickness of the lines [m].
    """

    name: str
    points: Float[np.ndarray, "t n 3"]
    lines: Int[np.ndarray, "k 2"]
    tone: Tone
    radius: float
    width: float

    def __post_init__(self) -> None:
        if not self.known.any():
            raise ValueError(f"{self.name}: no point is known in any frame")
        if self.lines.size and (self.lines.min() < 0 or self.lines.max() >= self.points.shape[1]):
            raise ValueError(f"{self.name}: a line names a point that is not there")

    @property
    def known(self) -> Bool[np.ndarray, "t n"]:
        """Which points are known in which frame."""
        return np.asarray(np.isfinite(self.points).all(axis=2))

    @property
    def places(self) -> Float[np.ndarray, "k 3"]:
        """All places that a point is at in some frame [m]."""
        return np.asarray(self.points[self.known])

    @property
    def grid(self) -> Grid:
        """Around all places."""
        return Grid.around(self.places)

    def words(self) -> UInt16[np.ndarray, "t m"]:
        """Steps of the grid, x y z of each point in turn; `MISSING` where it is not known."""
        words = np.full(self.points.shape, MISSING, np.uint16)
        words[self.known] = np.minimum(self.grid.steps(self.places), MISSING - 1)
        return words.reshape(len(self.points), -1)
