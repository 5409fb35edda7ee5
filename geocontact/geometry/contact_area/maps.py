"""Distance maps of many frames, gathered while an evolution is computed."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.contact_area.evolution import FrameContact
from geocontact.geometry.surface import Surface


class DistanceMaps:
    """Signed distance of each vertex to the other body, frame by frame: `area_evolution(…, each=maps.add)`.

    Distances are in m, infinite (negative deep inside) beyond what the evolution asked for, unsigned against an open
    body. Memory: 8 bytes per vertex and frame kept.

    Parameters
    ----------
    moving, fixed
        The two bodies of the evolution.
    every
        Keep frames 0, every, 2 every, …; 0 keeps none of these. The frame in which FIXED has most contact and the one
        with the smallest distance are kept in any case.

    Attributes
    ----------
    largest, nearest
        Numbers of these two frames.

    Examples
    --------
    >>> import geocontact as gc
    >>> femoral = gc.read_surface("meshes/femoral_component_right_coarse.stl", "mm")
    >>> insert = gc.read_surface("meshes/tibial_insert_right_coarse.stl", "mm")
    >>> maps = gc.DistanceMaps(femoral, insert, every=50)
    >>> settings = gc.Settings(rule="clip")
    >>> found = gc.area_evolution(femoral, insert, gc.read_motion("meshes/gait.csv"), settings, each=maps.add)
    >>> maps.frames
    [0, 50, 54, 56, 100]
    """

    def __init__(self, moving: Surface, fixed: Surface, every: int = 1) -> None:
        self.every = every
        self.largest = self.nearest = 0
        self._bodies = moving, fixed
        self._area, self._distance = -1.0, np.inf
        self._kept: dict[int, tuple[Float[np.ndarray, " n"], Float[np.ndarray, " m"]]] = {}

    def add(self, frame: int, contact: FrameContact) -> None:
        """Take in one frame."""
        area = max(side.area for side in contact.fixed)
        largest, nearest = area > self._area, contact.min_distance < self._distance
        if not (largest or nearest or self._regular(frame)):
            return
        before = {self.largest, self.nearest}
        if largest:
            self._area, self.largest = area, frame
        if nearest:
            self._distance, self.nearest = contact.min_distance, frame
        for old in before - {self.largest, self.nearest}:
            if not self._regular(old):
                self._kept.pop(old, None)
        moving, fixed = self._bodies
        on_fixed = at_vertices(fixed, contact.fixed_distances.signed)
        self._kept[frame] = on_fixed, at_vertices(moving, contact.moving_distances.signed)

    @property
    def frames(self) -> list[int]:
        """Numbers of the frames kept, in order."""
        return sorted(self._kept)

    @property
    def fixed(self) -> Float[np.ndarray, "t n"]:
        """Maps on FIXED of the frames kept [m]."""
        return np.array([self._kept[k][0] for k in self.frames]).reshape(-1, len(self._bodies[1].vertices))

    @property
    def moving(self) -> Float[np.ndarray, "t m"]:
        """Maps on MOVING of the frames kept [m]."""
        return np.array([self._kept[k][1] for k in self.frames]).reshape(-1, len(self._bodies[0].vertices))

    @property
    def fixed_at_largest(self) -> Float[np.ndarray, " n"]:
        """FIXED's map in the frame with most contact [m]."""
        return self._kept[self.largest][0]

    def _regular(self, frame: int) -> bool:
        return self.every > 0 and frame % self.every == 0


def at_vertices(surface: Surface, along_walk: Float[np.ndarray, " k"]) -> Float[np.ndarray, " n"]:
    """Values in the order of `surface.walk` brought to vertex order; infinite for vertices without a face."""
    values = np.full(len(surface.vertices), np.inf)
    values[surface.walk] = along_walk
    return values
