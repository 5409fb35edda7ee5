"""Vertices at the same place: STL files repeat every vertex in each face."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int


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
