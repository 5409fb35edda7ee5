"""The part of a surface that a shape is fitted to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface


@dataclass(frozen=True, eq=False)
class Patch:
    """A surface and the faces of it that count, with the two sides of it where it is split."""

    surface: Surface
    faces: Bool[np.ndarray, " m"]
    at_vertices: bool
    split: Plane | None
    medial: int

    @property
    def points(self) -> Float[np.ndarray, "n 3"]:
        """What the shape is fitted to [m]."""
        if self.at_vertices:
            return np.asarray(self.surface.vertices[self.vertices])
        return np.asarray(self.surface.vertices[self.surface.faces[self.faces]].mean(axis=1))

    @property
    def vertices(self) -> Bool[np.ndarray, " n"]:
        """Vertices of the faces that count."""
        used = np.zeros(len(self.surface.vertices), bool)
        used[self.surface.faces[self.faces]] = True
        return used

    @property
    def sides(self) -> Mapping[str, tuple[Plane, int]]:
        """Plane and side of it by name; empty without a split."""
        if self.split is None:
            return {}
        return {"medial": (self.split, self.medial), "lateral": (self.split, -self.medial)}
