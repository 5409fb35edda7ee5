"""The outer surface of a mesh of several closed surfaces, some of which lie inside or across others.

Segmented bones keep the wall of a marrow cavity, parts of a device are exported together: each closed surface is sound
and the mesh is closed, but what lies inside another one is no surface of the body. Each closed surface is taken as the
body that it bounds, whichever way its faces are wound. Their faces are cut along each other, and of each part the
middle says whether it is inside another body. Where two faces lie in one place, the one of the earlier surface counts
if both look the same way, and none if they are back to back: there the bodies touch.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from geocontact.geometry.cutting import CutFaces, cut_along, face_pairs, triangles, unit_normals
from geocontact.geometry.surface import Surface
from geocontact.geometry.topology import signed_volume


@dataclass(frozen=True, eq=False)
class ClosedPieces:
    """Pieces of a surface that hang together by edges.

    Parameters
    ----------
    piece
        Number of the piece of each face.
    closed
        Whether each piece bounds a body by itself: all its edges belong to two faces of opposite direction.
    """

    piece: Int[np.ndarray, " m"]
    closed: Bool[np.ndarray, " p"]

    @property
    def count(self) -> int:
        """Closed pieces."""
        return int(self.closed.sum())

    def boxes(self, corners: Float[np.ndarray, "m 3 3"]) -> tuple[Float[np.ndarray, "p 3"], Float[np.ndarray, "p 3"]]:
        """Lower and upper corner of the box of each piece [m], from the corners of all faces."""
        low, high = np.full((len(self.closed), 3), np.inf), np.full((len(self.closed), 3), -np.inf)
        np.minimum.at(low, self.piece, corners.min(axis=1))
        np.maximum.at(high, self.piece, corners.max(axis=1))
        return low, high


def closed_pieces(surface: Surface) -> ClosedPieces:
    """Pieces of a surface; two that share a corner only are two, faces with two equal corners belong to none closed."""
    faces = surface.topology.merged[surface.faces]
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(faces)), 3)
    flat = (faces == np.roll(faces, -1, axis=1)).any(axis=1)
    kept = ~flat[owner]
    start, end, owner = start[kept], end[kept], owner[kept]
    key = np.minimum(start, end) * np.int64(len(surface.vertices)) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    key, owner, ahead = key[order], owner[order], (start < end)[order]
    _, first, inverse, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
    link = coo_array((np.ones(len(owner), np.int8), (owner, owner[first][inverse])), shape=(len(faces),) * 2)
    number, piece = connected_components(link, directed=False)
    regular = (count == 2) & (np.bincount(inverse, weights=ahead) == 1)
    closed = np.ones(number, bool)
    closed[piece[owner[~regular[inverse]]]] = False
    closed[piece[flat]] = False
    return ClosedPieces(np.asarray(piece), closed)


ROUNDING = 2e-7
"""Share of the largest coordinate that files of single precision resolve, twice: heights up to it are none."""

WHOLE = 1.0 - 1e-9
"""Share of a surface's area inside others from which all of it is."""


@dataclass(frozen=True, eq=False)
class UnitedSurface:
    """Outer surface of a mesh.

    Parameters
    ----------
    surface
        What is left of the mesh: closed where the mesh is.
    face
        Face of the mesh that each of its faces is, or is cut from.
    count
        Closed surfaces of the mesh.
    inside, across
        How many of these lie inside others as a whole, and in part.
    inner_area
        Area of the mesh that is left out [m^2].
    """

    surface: Surface
    face: Int[np.ndarray, " m"]
    count: int
    inside: int
    across: int
    inner_area: float

    @property
    def words(self) -> str:
        """What the mesh holds: "2 closed surfaces, one inside the other"."""
        if self.count == 2:
            return "2 closed surfaces" + (", one inside the other" if self.inside else " that overlap")
        parts = [f"{self.inside} inside another one"] * bool(self.inside)
        parts += [f"{self.across} that overlap"] * bool(self.across)
        return f"{self.count} closed surfaces, {' and '.join(parts)}"

    @property
    def reservation(self) -> str:
        """What to say where all of it counts."""
        whole = self.inner_area + float(self.surface.face_area.sum())
        inside = f"{self.inner_area * 1e6:.1f} of its {whole * 1e6:.1f} mm^2 lie inside another one"
        return f"{self.surface.name} holds {self.words}: {inside} and count as surface all the same"


def united(surface: Surface) -> UnitedSurface | None:
    """Outer surface of a mesh; None where no closed surface lies inside or across another one.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> from geocontact.geometry.union import united
    >>> ball = gc.read_surface("meshes/sphere_r20.stl", "mm")
    >>> both = np.concatenate([ball.vertices, 0.5 * ball.vertices])
    >>> cored = gc.Surface(both, np.concatenate([ball.faces, ball.faces + len(ball.vertices)]))
    >>> found = united(cored)
    >>> found.words, len(found.surface.faces) == len(ball.faces)
    ('2 closed surfaces, one inside the other', True)
    """
    pieces = closed_pieces(surface)
    if pieces.count < 2:
        return None
    size = np.abs(surface.vertices[surface.used]).max()
    meeting = _Meeting(surface, pieces, ROUNDING * float(size))
    parts = meeting.parts()
    inner = meeting.inner(parts)
    if not inner.any():
        return None
    return _left(surface, pieces, parts, inner)


@dataclass(frozen=True, eq=False)
class _Parts:
    """Faces cut along each other: corners about the surface's centre [m], triangles, and the face of each."""

    points: Float[np.ndarray, "n 3"]
    triangles: Int[np.ndarray, "k 3"]
    face: Int[np.ndarray, " k"]

    @property
    def middle(self) -> Float[np.ndarray, "k 3"]:
        return np.asarray(self.points[self.triangles].mean(axis=1))

    @property
    def area(self) -> Float[np.ndarray, " k"]:
        c = self.points[self.triangles]
        return np.asarray(0.5 * np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1))


class _Meeting:
    """The closed pieces of a surface that come near each other."""

    def __init__(self, surface: Surface, pieces: ClosedPieces, near: float) -> None:
        self._pieces, self._near = pieces, near
        self._faces = surface.topology.merged[surface.faces]
        self._local, self._corners = surface.local, surface.corners
        low, high = pieces.boxes(self._corners)
        self._low, self._high = low - near, high + near
        self._least, self._most = self._corners.min(axis=1), self._corners.max(axis=1)
        numbers = np.flatnonzero(pieces.closed)
        self._met = {int(k): met for k in numbers if len(met := self._others(int(k), numbers))}

    def parts(self) -> _Parts:
        """All faces of the surface, those of its closed pieces cut where they cross each other."""
        pairs = [self._pairs(number, met) for number, met in self._met.items()]
        every = np.concatenate(pairs) if pairs else np.zeros((0, 2), np.int64)
        if not len(every):
            return _Parts(self._local, self._faces, np.arange(len(self._faces)))
        cut = CutFaces(self._local, self._faces, self._near)
        cut_along(cut, self._corners, self._corners, every, self._near)
        polygons = list(cut.polygons())
        points = cut.points
        fans = [polygon for _, polygon in polygons if len(polygon) > 3]
        middles = [points[polygon].mean(axis=0) for polygon in fans]
        found, owner, after = [], [], len(points)
        for face, polygon in polygons:
            made = triangles(polygon, after)
            after += len(polygon) > 3
            found += made
            owner += [face] * len(made)
        return _Parts(np.concatenate([points, np.reshape(middles, (-1, 3))]), np.array(found), np.array(owner))

    def inner(self, parts: _Parts) -> Bool[np.ndarray, " k"]:
        """Triangles that are no part of the outer surface."""
        out = np.zeros(len(parts.face), bool)
        middle, piece = parts.middle, self._pieces.piece[parts.face]
        outward = unit_normals(self._corners)[parts.face] * self._turned()[piece][:, None]
        for number, met in self._met.items():
            asked = np.isin(piece, met) & ~out
            asked &= ((middle >= self._low[number]) & (middle <= self._high[number])).all(axis=1)
            at = np.flatnonzero(asked)
            if len(at):
                out[at] = self._in_body(number, middle[at], outward[at], piece[at])
        return out

    def _others(self, number: int, numbers: Int[np.ndarray, " p"]) -> Int[np.ndarray, " q"]:
        """Closed pieces whose box meets that of one."""
        meets = (self._low[numbers] <= self._high[number]).all(axis=1)
        meets &= (self._high[numbers] >= self._low[number]).all(axis=1)
        return np.asarray(numbers[meets & (numbers != number)])

    def _pairs(self, number: int, met: Int[np.ndarray, " q"]) -> Int[np.ndarray, "k 2"]:
        """Faces of other pieces, and faces of this one that cross them; only those near its box are looked at."""
        near = (self._least <= self._high[number]).all(axis=1) & (self._most >= self._low[number]).all(axis=1)
        chosen = np.zeros(len(self._pieces.closed), bool)
        chosen[met] = True
        mine = np.flatnonzero(self._pieces.piece == number)
        other = np.flatnonzero(near & chosen[self._pieces.piece])
        if not len(other):
            return np.zeros((0, 2), np.int64)
        found = face_pairs(self._corners[other], self._corners[mine], self._near)
        return np.column_stack([other[found[:, 0]], mine[found[:, 1]]])

    def _turned(self) -> Float[np.ndarray, " p"]:
        """-1 for closed pieces whose faces point inwards, else 1."""
        out = np.ones(len(self._pieces.closed))
        for number in {int(k) for met in self._met.values() for k in met}:
            faces = self._faces[self._pieces.piece == number]
            out[number] = -1.0 if signed_volume(self._local, faces) < 0.0 else 1.0
        return out

    def _in_body(
        self,
        number: int,
        points: Float[np.ndarray, "k 3"],
        outward: Float[np.ndarray, "k 3"],
        piece: Int[np.ndarray, " k"],
    ) -> Bool[np.ndarray, " k"]:
        """Whether what surrounds points of other pieces lies in the body of this one."""
        corner, faces = np.unique(self._faces[self._pieces.piece == number], return_inverse=True)
        body = Surface(self._local[corner], faces.reshape(-1, 3))
        near = body.proximity(points, 10.0 * self._near)
        inside = near.distance < 0.0
        on_it = np.flatnonzero(np.abs(near.distance) <= 4.0 * self._near)
        same = np.einsum("ki,ki->k", outward[on_it], body.face_normal[near.face[on_it]])
        flat = np.abs(same) > 0.7
        inside[on_it[flat]] = (same[flat] < 0.0) | (number < piece[on_it[flat]])
        return np.asarray(inside)


def _left(surface: Surface, pieces: ClosedPieces, parts: _Parts, inner: Bool[np.ndarray, " k"]) -> UnitedSurface:
    """What is left of a surface, with its closed pieces turned outwards."""
    piece, area = pieces.piece[parts.face], parts.area
    total, lost = (np.bincount(piece, weights=w, minlength=len(pieces.closed)) for w in (area, area * inner))
    whole = lost >= WHOLE * total
    kept = np.flatnonzero(~inner)
    faces = parts.triangles[kept]
    for number in np.flatnonzero(pieces.closed & (lost > 0.0) & ~whole):
        mine = piece == number
        if signed_volume(parts.points, parts.triangles[mine]) < 0.0:
            turned = mine[kept]
            faces[turned] = faces[turned][:, ::-1]
    corner, compact = np.unique(faces, return_inverse=True)
    left = Surface(
        parts.points[corner] + surface.centre,
        compact.reshape(-1, 3),
        surface.name,
        surface.assume_closed,
        surface.space,
    )
    if surface.closed and not left.topology.closed:  # seams where corners of the one lie on edges of the other
        left = replace(left, assume_closed=True)
    return UnitedSurface(
        surface=left,
        face=parts.face[kept],
        count=pieces.count,
        inside=int((pieces.closed & whole).sum()),
        across=int((pieces.closed & (lost > 0.0) & ~whole).sum()),
        inner_area=float(lost.sum()),
    )
