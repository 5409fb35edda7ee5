"""Cutting faces along other faces: what is left of each is crossed by none of them.

A face is a convex polygon. It is cut by the plane of another face only where that face really crosses it, piece by
piece, so that a long face across many small ones stays in few pieces. A cut edge is remembered by its two ends: the
neighbour across it gets the same corner, and a closed surface stays closed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

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


Point = Float[np.ndarray, " 3"]


@dataclass(frozen=True, eq=False)
class FaceCut:
    """A plane, and the straight part of it that cuts: where another face meets the plane of the one that is cut."""

    point: Point
    normal: Point
    ends: Float[np.ndarray, "2 3"]


def cuts(
    face: Float[np.ndarray, "3 3"], normal: Point, other: Float[np.ndarray, "3 3"], near: float
) -> Iterator[FaceCut]:
    """Where a triangle cuts the plane of a face: along one line, or along its edges where it lies in that plane."""
    across = unit_normals(other[None])[0]
    if not across.any() or not normal.any():
        return
    height = (other - face[0]) @ normal
    height[np.abs(height) <= near] = 0.0
    if not height.any():
        for a, b in ((0, 1), (1, 2), (2, 0)):
            beside = np.cross(normal, other[b] - other[a])
            length = float(np.linalg.norm(beside))
            if length > 0.0:
                yield FaceCut(other[a], beside / length, other[[a, b]])
        return
    ends = [other[k] for k in range(3) if height[k] == 0.0]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        if height[a] * height[b] < 0.0:
            ends.append(other[a] + height[a] / (height[a] - height[b]) * (other[b] - other[a]))
    if len(ends) == 2:
        yield FaceCut(other[0], across, np.array(ends))


class CutFaces:
    """Polygons that faces are cut into.

    Parameters
    ----------
    vertices, faces
        The faces, with one index for each place.
    near
        Heights above a plane up to which a corner lies in it [m].
    """

    def __init__(self, vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], near: float) -> None:
        self._points = list(vertices)
        self._halves: dict[tuple[int, int], int] = {}
        self._near = near
        self._polygons: list[list[list[int]]] = [[[int(k) for k in face]] for face in faces]

    @property
    def points(self) -> Float[np.ndarray, "n 3"]:
        """Corners: those given, then those that cuts have made [m]."""
        return np.array(self._points)

    def cut(self, number: int, cut: FaceCut) -> None:
        """Cut a face where it is crossed."""
        out = []
        for polygon in self._polygons[number]:
            out.extend(self._parts(self._whole(polygon), cut))
        self._polygons[number] = out

    def polygons(self) -> Iterator[tuple[int, list[int]]]:
        """Number of the face and corners of each part, corners on the edges included."""
        for number, parts in enumerate(self._polygons):
            for polygon in parts:
                yield number, self._whole(polygon)

    def _whole(self, polygon: list[int]) -> list[int]:
        """With the corners that neighbours have put on its edges."""
        out: list[int] = []
        for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
            out.append(a)
            out.extend(self._between(a, b))
        return out

    def _between(self, a: int, b: int) -> list[int]:
        middle = self._halves.get((min(a, b), max(a, b)))
        return [] if middle is None else [*self._between(a, middle), middle, *self._between(middle, b)]

    def _parts(self, polygon: list[int], cut: FaceCut) -> list[list[int]]:
        place = np.array([self._points[k] for k in polygon])
        height = (place - cut.point) @ cut.normal
        height[np.abs(height) <= self._near] = 0.0
        if not (height.min() < 0.0 < height.max()):
            return [polygon]
        line = []
        for k, h in enumerate(height):
            after = (k + 1) % len(height)
            if h == 0.0:
                line.append(place[k])
            elif h * height[after] < 0.0:
                line.append(place[k] + h / (h - height[after]) * (place[after] - place[k]))
        along = line[-1] - line[0]
        length = float(np.linalg.norm(along))
        reach = (cut.ends - line[0]) @ along / max(length, 1e-300)
        if min(length, reach.max()) - max(0.0, reach.min()) <= self._near:
            return [polygon]
        return self._two(polygon, height)

    def _two(self, polygon: list[int], height: Float[np.ndarray, " k"]) -> list[list[int]]:
        below: list[int] = []
        above: list[int] = []
        for k, corner in enumerate(polygon):
            after = (k + 1) % len(polygon)
            if height[k] <= 0.0:
                below.append(corner)
            if height[k] >= 0.0:
                above.append(corner)
            if height[k] * height[after] < 0.0:
                middle = self._split(corner, polygon[after], float(height[k] / (height[k] - height[after])))
                below.append(middle)
                above.append(middle)
        return [below, above]

    def _split(self, a: int, b: int, share: float) -> int:
        self._points.append(self._points[a] + share * (self._points[b] - self._points[a]))
        self._halves[min(a, b), max(a, b)] = len(self._points) - 1
        return len(self._points) - 1


def cut_along(faces: CutFaces, corners: Corners, others: Corners, pairs: Pairs, near: float) -> None:
    """Cut faces by all that cross them; `pairs` are indices in `corners`, which are theirs, and in `others`."""
    normal = unit_normals(corners)
    for number, other in pairs:
        for cut in cuts(corners[number], normal[number], others[other], near):
            faces.cut(int(number), cut)


def triangles(polygon: list[int], middle: int) -> list[tuple[int, int, int]]:
    """A triangle as it is, else a fan about a corner in the middle: right for corners in a line, too."""
    if len(polygon) == 3:
        return [(polygon[0], polygon[1], polygon[2])]
    return [(a, b, middle) for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True)]
