"""Vertices at the same place, as STL files repeat every vertex in each face; faces with the same vertices."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int


def first_of_coincident(vertices: Float[np.ndarray, "n 3"]) -> Int[np.ndarray, " n"]:
    """For each vertex the lowest index of a vertex that equals it to the last bit; -0 equals 0. Must be finite."""
    values = vertices + vertices.dtype.type(0)  # -0 + 0 is +0
    order = np.lexsort(values.T)
    opens = np.zeros(len(order), dtype=bool)  # whether a vertex differs from the one before it in that order
    opens[:1] = True
    for column in values.T:
        ranked = column[order]
        opens[1:] |= ranked[1:] != ranked[:-1]
    first = order[opens]  # the sort is stable: the first of equals has the smallest index
    representative = np.empty(len(order), dtype=np.int64)
    representative[order] = first[np.cumsum(opens) - 1]
    return representative


def repeated_faces(faces: Int[np.ndarray, "m 3"]) -> Bool[np.ndarray, " m"]:
    """Which faces have the same three vertices, in any order, as a face before them."""
    corners = faces.astype(np.int32)
    corners.sort(axis=1)
    order = np.lexsort(corners.T)
    same = np.ones(max(len(faces) - 1, 0), dtype=bool)
    for column in corners.T:
        ranked = column[order]
        same &= ranked[1:] == ranked[:-1]
    again = np.zeros(len(faces), dtype=bool)
    again[order[1:]] = same
    return again
