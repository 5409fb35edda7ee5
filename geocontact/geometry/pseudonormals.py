"""Angle-weighted normals of the edges and corners of triangles, for telling inside from outside."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int, Int32

EDGES = ((0, 1), (0, 2), (1, 2))
"""Corners of the record that each edge joins, in the order of `closest_point`."""
BLOCK = 1 << 18
"""Faces that are taken together: what is needed of them meanwhile stays small."""


def pseudonormals(
    records: Float[np.ndarray, "m 16"], faces: Int[np.ndarray, "m 3"], merged: Int[np.ndarray, " n"]
) -> tuple[Float[np.ndarray, "k 3"], Int32[np.ndarray, "m 6"]]:
    """Unit normals, and which of them the three edges and three corners of each face have (order of `closest_point`).

    Edges take the sum of their two faces' normals, corners the sum weighted by the faces' angles. Features that touch
    a face without area get no normal (zero): a side read from them would depend on rounding. The last one is zero.
    """
    shift = records[:, 15].astype(np.int64)
    turned = merged[np.take_along_axis(faces, (shift[:, None] + np.arange(3)) % 3, axis=1)]  # A, B, C of the record
    flat = records[:, 14] == 0.0
    unit = np.where(flat[:, None], 0.0, records[:, 3:6])
    row = np.empty((len(faces), 6), np.int32)
    of_edges, row[:, :3] = _edge_normals(turned, unit, flat)
    of_corners = _corner_normals(turned, records, unit, flat, len(merged))
    row[:, 3:] = len(of_edges) + turned
    normals = np.concatenate([of_edges, of_corners, np.zeros((1, 3))])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 1e-12), row


def _edge_normals(
    turned: Int[np.ndarray, "m 3"], unit: Float[np.ndarray, "m 3"], flat: np.ndarray
) -> tuple[Float[np.ndarray, "q 3"], Int[np.ndarray, "m 3"]]:
    """Sum of the normals at each edge, and the edges of each face."""
    most = np.int64(turned.max()) + 1
    ends = [(turned[:, start], turned[:, end]) for start, end in EDGES]
    keys = np.concatenate([np.minimum(a, b) * most + np.maximum(a, b) for a, b in ends])
    edge = np.unique(keys, return_inverse=True)[1].reshape(3, -1)
    total = np.zeros((edge.max() + 1, 3))
    doubtful = np.zeros(len(total), bool)
    for each in edge:
        np.add.at(total, each, unit)
        doubtful[each[flat]] = True
    total[doubtful] = 0.0
    return total, edge.T


def _corner_normals(
    turned: Int[np.ndarray, "m 3"],
    records: Float[np.ndarray, "m 16"],
    unit: Float[np.ndarray, "m 3"],
    flat: np.ndarray,
    count: int,
) -> Float[np.ndarray, "n 3"]:
    """Sum of the normals at each vertex, weighted by the faces' angles there."""
    total = np.zeros((count, 3))
    for start in range(0, len(turned), BLOCK):
        here = slice(start, start + BLOCK)
        length, cx, cy = records[here, 12], records[here, 13], records[here, 14]
        at_a, at_b = np.arctan2(cy, cx), np.arctan2(cy, length - cx)
        angle = np.stack([at_a, at_b, np.pi - at_a - at_b], axis=1)
        np.add.at(total, turned[here].ravel(), (angle[:, :, None] * unit[here, None, :]).reshape(-1, 3))
    total[turned[flat].ravel()] = 0.0
    return total
