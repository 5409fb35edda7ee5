"""Closed triangle meshes of the body segments, vertices on the formulas of `meshes.segments`."""

from __future__ import annotations

import numpy as np

from meshes.segments import SHANK, THIGH, TORSO, UPPER_ARM, Segment
from meshes.simple_shapes import cylinder
from meshes.stl import snapped

RINGS = {THIGH: 10, SHANK: 8, UPPER_ARM: 9, TORSO: 12}
"""Hexagonal rings n of the shipped meshes' ends, 6 n faces around the skin: edges of 6 to 13 mm."""


def segment_mesh(segment: Segment, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [mm] and faces: a cylinder of the same girth, its mantle and ends moved out to r(theta, y)."""
    mean_radius = float(np.sqrt(segment.oval.front * segment.oval.side))
    vertices, faces = cylinder(mean_radius, segment.length, n)
    theta, part = np.arctan2(-vertices[:, 1], vertices[:, 0]), np.hypot(*vertices[:, :2].T) / mean_radius
    out = part * segment.radius(np.column_stack([theta, vertices[:, 2]]))[:, 0]
    return snapped(np.column_stack([out * np.cos(theta), vertices[:, 2], out * np.sin(theta)])), faces
