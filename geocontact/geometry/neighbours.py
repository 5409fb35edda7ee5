"""Which face lies across which edge."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int


def neighbours(faces: Int[np.ndarray, "m 3"]) -> Int[np.ndarray, "m 3"]:
    """The face across the edge from corner k to corner k + 1 of each face, -1 where the surface ends.

    It ends where an edge belongs to one face only, to more than two, or to two that are turned against each other. A
    face with two equal corners is no part of it: its neighbours meet.
    """
    proper = np.flatnonzero((faces != np.roll(faces, -1, axis=1)).all(axis=1))
    start = faces[proper].ravel()
    end = np.roll(faces[proper], -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((start > end, high, low))
    same = (low[order][1:] == low[order][:-1]) & (high[order][1:] == high[order][:-1])
    opens = np.concatenate([[True], ~same])
    run = np.cumsum(opens) - 1
    pairs = np.flatnonzero(opens)[np.bincount(run) == 2]
    first, second = order[pairs], order[pairs + 1]
    opposite = start[first] == end[second]
    first, second = first[opposite], second[opposite]
    across = np.full(faces.size, -1, np.int64)
    owner = 3 * proper[:, None] + np.arange(3)
    edge = owner.ravel()
    across[edge[first]], across[edge[second]] = edge[second] // 3, edge[first] // 3
    return across.reshape(faces.shape)
