"""Triangulations of rectangles and discs, from which the bodies are bent."""

from __future__ import annotations

import numpy as np


def quads_of(index: np.ndarray) -> np.ndarray:
    """Cells (n, 4) of a rectangular array of node numbers, running along the columns first."""
    return np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)


def split_quads(vertices: np.ndarray, quads: np.ndarray) -> np.ndarray:
    """Two triangles for each quad, cut along its clearly shorter diagonal (the first one if they are equal)."""
    a, b, c, d = (vertices[quads[:, k]] for k in range(4))
    second = np.linalg.norm(b - d, axis=1) < np.linalg.norm(a - c, axis=1) - 1e-6
    first_cut = quads[:, [0, 1, 2, 0, 2, 3]]
    second_cut = quads[:, [0, 1, 3, 1, 2, 3]]
    return np.where(second[:, None], second_cut, first_cut).reshape(-1, 3)


def hexagonal_disc(rings: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A unit disc of `rings` hexagonal rings: radius (0..1) and part of a turn (0..1) of the nodes, 6 rings^2 faces."""
    ring = np.repeat(np.arange(rings + 1), [1, *(6 * k for k in range(1, rings + 1))])
    start = np.concatenate([[0], 1 + 3 * np.arange(rings + 1) * np.arange(1, rings + 2)])
    place = np.arange(len(ring)) - start[ring]
    faces = []
    for k in range(1, rings + 1):
        i = np.arange(6 * k)
        sector, step = np.divmod(i, k)
        inside = start[k - 1] + (sector * (k - 1) + step) % max(1, 6 * (k - 1))
        outside, following = start[k] + i, start[k] + (i + 1) % (6 * k)
        faces.append(np.column_stack([inside, outside, following]))
        keep = step < k - 1
        next_inside = start[k - 1] + (sector * (k - 1) + step + 1) % max(1, 6 * (k - 1))
        faces.append(np.column_stack([inside, following, next_inside])[keep])
    return ring / rings, place / np.maximum(1, 6 * ring), np.vstack(faces)
