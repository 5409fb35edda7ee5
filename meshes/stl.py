"""Binary STL, written and read in a few lines, so that a file depends on nothing but its coordinates."""

from __future__ import annotations

from pathlib import Path

import numpy as np

FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
GRID_MM = 2.0**-15
"""Coordinates are rounded to this grid [mm]: exact in float32 below 512 mm, and the same on every machine."""


def snapped(vertices: np.ndarray) -> np.ndarray:
    """Vertices [mm] on the grid that the file holds exactly; negative zeros removed."""
    return np.round(vertices / GRID_MM) * GRID_MM + 0.0


def stl_bytes(vertices: np.ndarray, faces: np.ndarray, title: str) -> bytes:
    """A binary STL of the surface; vertices in mm, `title` (at most 80 characters) as header.

    Normals follow from the corners by the right-hand rule.
    """
    corners = snapped(vertices)[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    facets = np.zeros(len(faces), FACET)
    # Whole millionths: the last bit of a square root may differ between machines.
    facets["normal"] = np.round(normals, 6) + 0.0
    facets["corners"] = corners
    return title.encode("ascii").ljust(80)[:80] + np.uint32(len(faces)).astype("<u4").tobytes() + facets.tobytes()


def read_stl(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [mm] and faces of a binary STL of ours; equal corners become one vertex, in order of appearance."""
    facets = np.frombuffer(path.read_bytes(), FACET, offset=84)
    corners = facets["corners"].astype(float).reshape(-1, 3)
    _, first, inverse = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return corners[first[order]], rank[inverse.ravel()].reshape(-1, 3)
