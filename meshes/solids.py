"""Closed bodies from two sheets of the same triangulation, and the checks that a body is clean."""

from __future__ import annotations

import numpy as np

from meshes.sheets import split_quads


def boundary_edges(faces: np.ndarray) -> np.ndarray:
    """Directed edges (e, 2) that belong to one face only."""
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    keys = edges[:, 0] * (faces.max() + 1) + edges[:, 1]
    mirrored = edges[:, 1] * (faces.max() + 1) + edges[:, 0]
    return edges[~np.isin(keys, mirrored)]


def thicken(outer: np.ndarray, inner: np.ndarray, faces: np.ndarray, layers: int) -> tuple[np.ndarray, np.ndarray]:
    """Closed body between two sheets that share `faces`: outer sheet, reversed inner sheet, ruled wall between them.

    `faces` are seen counter-clockwise from outside on the outer sheet; the wall has `layers` rows of quads.
    """
    rim = boundary_edges(faces)
    ring = np.unique(rim)
    position = np.full(len(outer), -1)
    position[ring] = np.arange(len(ring))
    levels = np.linspace(0, 1, layers + 1)[1:-1, None, None]
    between = ((1 - levels) * outer[ring] + levels * inner[ring]).reshape(-1, 3)
    vertices = np.vstack([outer, inner, between])

    def at_level(level: int, index: np.ndarray) -> np.ndarray:
        if level in (0, layers):
            return index + (len(outer) if level else 0)
        return 2 * len(outer) + (level - 1) * len(ring) + position[index]

    wall = [
        np.column_stack(
            [at_level(k, rim[:, 1]), at_level(k, rim[:, 0]), at_level(k + 1, rim[:, 0]), at_level(k + 1, rim[:, 1])]
        )
        for k in range(layers)
    ]
    return vertices, np.vstack([faces, faces[:, ::-1] + len(outer), split_quads(vertices, np.vstack(wall))])


def mirrored(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The body reflected in the plane z = 0, faces turned so that they still look outwards (right knee to left)."""
    return vertices * [1, 1, -1], faces[:, ::-1]


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Enclosed volume, positive when the faces look outwards; in the cube of the vertices' unit."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def area(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Area of all triangles, in the square of the vertices' unit."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def is_closed(faces: np.ndarray) -> bool:
    """Whether every edge belongs to exactly two faces that run through it in opposite directions."""
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    forward = {tuple(e) for e in edges.tolist()}
    return len(forward) == len(edges) and all((b, a) in forward for a, b in forward)


def smallest_angle(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Smallest angle of all triangles [deg]; 0 for a degenerate one."""
    corners = vertices[faces]
    sides = [corners[:, (k + 1) % 3] - corners[:, k] for k in range(3)]
    angles = [
        np.arctan2(
            np.linalg.norm(np.cross(sides[k], -sides[k - 1]), axis=1), np.einsum("ij,ij->i", sides[k], -sides[k - 1])
        )
        for k in range(3)
    ]
    return float(np.degrees(np.min(angles)))
