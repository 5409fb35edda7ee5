"""Contact area of FIXED on either side of a plane, with the centre of each side's patch, pose by pose.

What `evolution` counts, without what a chain of links does not need: MOVING's own area, the separation, the sum of both
sides. A face belongs to the side that its centroid is on.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.contact_area.area import Refinement, area_within
from geocontact.geometry.contact_area.sampled import Sampled
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface


class SidedAreas:
    """Two surfaces prepared once and evaluated at as many poses as wanted.

    Parameters
    ----------
    moving, fixed
        The two bodies, each in its own frame [m].
    threshold
        Largest signed distance that counts as contact [m].
    split
        Plane in FIXED's frame; the side of its negative heights comes first.
    faces
        Marks the faces of FIXED that count; None for all.
    """

    def __init__(
        self,
        moving: Surface,
        fixed: Surface,
        threshold: float,
        split: Plane,
        faces: Bool[np.ndarray, " f"] | None = None,
    ) -> None:
        height = split.height(fixed.vertices[fixed.faces].mean(axis=1))
        counts = np.ones(len(fixed.faces), bool) if faces is None else faces
        self.threshold = threshold
        self.moving = moving
        self._sides = tuple(Sampled.of(fixed, threshold, counts & side) for side in (height <= 0.0, height > 0.0))
        if any(len(side.faces) == 0 for side in self._sides):
            raise ValueError(f"{fixed.name}: all faces that count lie on one side of the plane that splits it")
        _ = (moving.tree, moving.closed and moving.normals_trusted)  # built here, before threads share them

    @property
    def middle(self) -> Float[np.ndarray, "2 3"]:
        """Area centroid of all faces of each side [m]."""
        return np.array([s.moment.sum(axis=0) / s.area.sum() + s.surface.centre for s in self._sides])

    def at(
        self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"], refinement: Refinement
    ) -> Float[np.ndarray, "2 4"]:
        """Area of each side [m^2] and its first moment [m^3], with MOVING at x_fixed = rotation x + translation."""
        back = np.ascontiguousarray(rotation.T)
        origin = -back @ translation
        distances = self._sides[0].distances(self.moving, back, origin)
        found = [area_within(s, self.moving, distances, self.threshold, back, origin, refinement) for s in self._sides]
        return np.array([[one.area, *one.moment] for one in found])

    def along(
        self, rotation: Float[np.ndarray, "t 3 3"], translation: Float[np.ndarray, "t 3"], refinement: Refinement
    ) -> Float[np.ndarray, "t 2 4"]:
        """The same for many poses, on all cores."""
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            found = list(pool.map(lambda r, p: self.at(r, p, refinement), rotation, translation))
        return np.array(found).reshape(-1, 2, 4)
