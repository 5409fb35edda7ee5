"""Distance maps of many frames, gathered while an evolution is computed."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.evolution import FrameContact
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
        Keep frames 0, every, 2 every, …; 0 keeps only the frame in which FIXED has most contact.

    Attributes
    ----------
    frames
        Numbers of the frames kept.
    largest
        Number of the frame with the largest area on FIXED at the last threshold.
    fixed_at_largest
        FIXED's map in that frame, shape (n,).
    """

    def __init__(self, moving: Surface, fixed: Surface, every: int = 1) -> None:
        self.every = every
        self.frames: list[int] = []
        self.largest = 0
        self.fixed_at_largest = np.full(len(fixed.vertices), np.inf)
        self._bodies = moving, fixed
        self._area = -1.0
        self._on_moving: list[np.ndarray] = []
        self._on_fixed: list[np.ndarray] = []

    def add(self, frame: int, contact: FrameContact) -> None:
        """Take in one frame."""
        moving, fixed = self._bodies
        area = contact.fixed[-1].area
        kept = self.every > 0 and frame % self.every == 0
        if not kept and area <= self._area:
            return
        on_fixed = at_vertices(fixed, contact.fixed_distances.signed)
        if area > self._area:
            self._area, self.largest, self.fixed_at_largest = area, frame, on_fixed
        if kept:
            self.frames.append(frame)
            self._on_fixed.append(on_fixed)
            self._on_moving.append(at_vertices(moving, contact.moving_distances.signed))

    @property
    def fixed(self) -> Float[np.ndarray, "t n"]:
        """Maps on FIXED of the frames kept [m]."""
        return np.array(self._on_fixed).reshape(-1, len(self._bodies[1].vertices))

    @property
    def moving(self) -> Float[np.ndarray, "t m"]:
        """Maps on MOVING of the frames kept [m]."""
        return np.array(self._on_moving).reshape(-1, len(self._bodies[0].vertices))


def at_vertices(surface: Surface, along_walk: Float[np.ndarray, " k"]) -> Float[np.ndarray, " n"]:
    """Values in the order of `surface.walk` brought to vertex order; infinite for vertices without a face."""
    values = np.full(len(surface.vertices), np.inf)
    values[surface.walk] = along_walk
    return values
