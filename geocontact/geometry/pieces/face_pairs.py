"""Pairs of faces of two sets that touch or cross each other."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

TOGETHER = 200_000
"""Pairs of boxes that are compared at once."""

Corners = Float[np.ndarray, "_ 3 3"]
Pairs = Int[np.ndarray, "_ 2"]


def face_pairs(first: Corners, second: Corners, near: float) -> Pairs:
    """Index in `first` and in `second` of faces that are not on one side of each other's plane, within `near` [m].

    Boxes are halved at the median of the longer set's middles until few enough are left to compare all with all.
    """
    boxes = [(each.min(axis=1) - 0.5 * near, each.max(axis=1) + 0.5 * near) for each in (first, second)]
    found: list[Pairs] = []
    waiting = [(np.arange(len(first)), np.arange(len(second)))]
    while waiting:
        sets = _within(waiting.pop(), boxes)
        if min(map(len, sets)) == 0:
            continue
        if len(sets[0]) * len(sets[1]) <= TOGETHER:
            found.append(_crossing(_all_with_all(sets, boxes), first, second, near))
            continue
        longer = int(len(sets[1]) > len(sets[0]))
        low, high = (end[sets[longer]] for end in boxes[longer])
        middle = 0.5 * (low + high)
        axis = int(np.argmax(np.ptp(middle, axis=0)))
        order = np.argsort(middle[:, axis], kind="stable")
        halves = np.array_split(sets[longer][order], 2)
        waiting += [(sets[0], half) if longer else (half, sets[1]) for half in halves]
    pairs = np.concatenate(found) if found else np.zeros((0, 2), np.int64)
    return np.asarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])


Boxes = list[tuple[Float[np.ndarray, "_ 3"], Float[np.ndarray, "_ 3"]]]
Sets = tuple[Int[np.ndarray, " _"], Int[np.ndarray, " _"]]


def _within(sets: Sets, boxes: Boxes) -> Sets:
    """Those of each set whose box meets the box about the other set."""
    out = []
    for k in (0, 1):
        mine, other = sets[k], sets[1 - k]
        if len(mine) == 0 or len(other) == 0:
            return mine[:0], other[:0]
        low, high = boxes[1 - k][0][other].min(axis=0), boxes[1 - k][1][other].max(axis=0)
        meets = (boxes[k][0][mine] <= high).all(axis=1) & (boxes[k][1][mine] >= low).all(axis=1)
        out.append(mine[meets])
    return out[0], out[1]


def _all_with_all(sets: Sets, boxes: Boxes) -> Pairs:
    (low, high), (low2, high2) = boxes
    a, b = sets
    meets = np.ones((len(a), len(b)), bool)
    for axis in range(3):
        meets &= low[a, None, axis] <= high2[None, b, axis]
        meets &= high[a, None, axis] >= low2[None, b, axis]
    i, j = np.nonzero(meets)
    return np.column_stack([a[i], b[j]])


def _crossing(pairs: Pairs, first: Corners, second: Corners, near: float) -> Pairs:
    """Pairs of which neither lies on one side of the other's plane."""
    one, other = first[pairs[:, 0]], second[pairs[:, 1]]
    return np.asarray(pairs[_straddles(one, other, near) & _straddles(other, one, near)])


def _straddles(plane_of: Corners, face: Corners, near: float) -> np.ndarray:
    height = heights(face, plane_of[:, 0], unit_normals(plane_of))
    return np.asarray((height.min(axis=1) <= near) & (height.max(axis=1) >= -near))


def unit_normals(corners: Corners) -> Float[np.ndarray, "m 3"]:
    """Unit normals of faces; zero where a face has no area."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0))


def heights(
    corners: Corners, point: Float[np.ndarray, "m 3"], normal: Float[np.ndarray, "m 3"]
) -> Float[np.ndarray, "m 3"]:
    """Heights of corners above planes through a point [m]."""
    return np.asarray(np.einsum("mki,mi->mk", corners - point[:, None], normal))
