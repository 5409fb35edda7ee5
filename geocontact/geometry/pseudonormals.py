"""Angle-weighted normals of the seven features of each triangle, for telling inside from outside."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int


def pseudonormals(
    records: Float[np.ndarray, "m 16"], faces: Int[np.ndarray, "m 3"], merged: Int[np.ndarray, " n"]
) -> Float[np.ndarray, "m 7 3"]:
    """Unit normals of interior, three edges and three corners of each face, in the order of `closest_point`.

    Edges take the sum of their two faces' normals, corners the sum weighted by the faces' angles. Features that touch
    a face without area get no normal (zero): a side read from them would depend on rounding.
    """
    shift = records[:, 15].astype(np.int64)
    turned = merged[np.take_along_axis(faces, (shift[:, None] + np.arange(3)) % 3, axis=1)]  # A, B, C of the record
    flat = records[:, 14] == 0.0
    unit = np.where(flat[:, None], 0.0, records[:, 3:6])
    normals = np.zeros((len(faces), 7, 3))
    normals[:, 0] = unit
    for place, (start, end) in enumerate(((0, 1), (0, 2), (1, 2)), start=1):
        normals[:, place] = _edge_normals(turned, unit, flat, start, end)
    normals[:, 4:7] = _corner_normals(turned, records, unit, flat, len(merged))
    length = np.linalg.norm(normals, axis=2, keepdims=True)
    return np.asarray(np.divide(normals, length, out=np.zeros_like(normals), where=length > 1e-12))


def _edge_key(turned: Int[np.ndarray, "m 3"], start: int, end: int) -> Int[np.ndarray, " m"]:
    a, b = turned[:, start], turned[:, end]
    return np.asarray(np.minimum(a, b) * (turned.max() + 1) + np.maximum(a, b))


def _edge_normals(
    turned: Int[np.ndarray, "m 3"],
    unit: Float[np.ndarray, "m 3"],
    flat: np.ndarray,
    start: int,
    end: int,
) -> Float[np.ndarray, "m 3"]:
    keys = np.concatenate([_edge_key(turned, a, b) for a, b in ((0, 1), (0, 2), (1, 2))])
    _, inverse = np.unique(keys, return_inverse=True)
    total = np.zeros((inverse.max() + 1, 3))
    np.add.at(total, inverse, np.tile(unit, (3, 1)))
    doubtful = np.zeros(len(total), bool)
    doubtful[inverse[np.tile(flat, 3)]] = True
    total[doubtful] = 0.0
    m = len(turned)
    place = ((0, 1), (0, 2), (1, 2)).index((start, end))
    return np.asarray(total[inverse[place * m : (place + 1) * m]])


def _corner_normals(
    turned: Int[np.ndarray, "m 3"],
    records: Float[np.ndarray, "m 16"],
    unit: Float[np.ndarray, "m 3"],
    flat: np.ndarray,
    count: int,
) -> Float[np.ndarray, "m 3 3"]:
    length, cx, cy = records[:, 12], records[:, 13], records[:, 14]
    at_a, at_b = np.arctan2(cy, cx), np.arctan2(cy, length - cx)
    angle = np.stack([at_a, at_b, np.pi - at_a - at_b], axis=1)
    total = np.zeros((count, 3))
    np.add.at(total, turned.ravel(), (angle[:, :, None] * unit[:, None, :]).reshape(-1, 3))
    doubtful = np.zeros(count, bool)
    doubtful[turned[flat].ravel()] = True
    total[doubtful] = 0.0
    return np.asarray(total[turned])
