"""Distance maps of all frames, gathered while the frames are computed."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.evolution import FrameContact
from geocontact.geometry.surface import Surface


class DistanceMaps:
    """Keeps the map of the frame with the largest area for the figure, and on request all maps for a file."""

    def __init__(self, moving: Surface, fixed: Surface) -> None:
        self.moving = moving
        self.fixed = fixed
        self.frame = 0
        self.shown = np.full(len(fixed.vertices), np.inf)
        self._largest = -1.0
        self._on_fixed: list[np.ndarray] = []
        self._on_moving: list[np.ndarray] = []

    def add(self, frame: int, contact: FrameContact, everything: bool) -> None:
        """Take in one frame."""
        area = contact.fixed[-1].area
        if area > self._largest:
            self._largest = area
            self.frame = frame
            self.shown = at_vertices(self.fixed, contact.fixed_distances.signed)
        if everything:
            self._on_fixed.append(at_vertices(self.fixed, contact.fixed_distances.signed))
            self._on_moving.append(at_vertices(self.moving, contact.moving_distances.signed))

    def write(self, file: Path, motion: Motion, evolution: AreaEvolution) -> None:
        """Compressed numpy archive, SI units; distances are infinite (negative deep inside) beyond what was asked for.

        Arrays: time (t,), thresholds (k,), X_FM (t, 4, 4), signed, and for each body vertices (n, 3), faces (m, 3),
        distance (t, n) of its vertices to the other body.
        """
        np.savez_compressed(
            file,
            allow_pickle=False,
            time=motion.time,
            thresholds=np.asarray(evolution.thresholds),
            X_FM=motion.poses.as_matrix().reshape(-1, 4, 4),
            signed=np.asarray(evolution.signed),
            fixed_vertices=self.fixed.vertices,
            fixed_faces=self.fixed.faces,
            fixed_distance=np.asarray(self._on_fixed),
            moving_vertices=self.moving.vertices,
            moving_faces=self.moving.faces,
            moving_distance=np.asarray(self._on_moving),
        )


def at_vertices(surface: Surface, along_walk: np.ndarray) -> np.ndarray:
    """Values in the order of `surface.walk` brought to vertex order; infinite for vertices without a face."""
    values = np.full(len(surface.vertices), np.inf)
    values[surface.walk] = along_walk
    return values
