"""Curvature of the smooth surface that triangles stand for, and how far it bulges out of them.

Triangles have no curvature. Over the plane at right angles to a vertex's normal the height of its neighbours is fitted
by least squares with a quadratic (Petitjean 2002, ACM Computing Surveys 34(2), 211; the "adjacent-quadratic" scheme of
Goldfeather and Interrante 2004, ACM TOG 23(1), 45, without its normals),

    h = f + d u + e v + (a u² + 2 b u v + c v²)/2

and the curvature of that graph at its middle is the result. The neighbours are all vertices within a radius whose
normals are within 60° of the vertex's own: thin parts and sharp edges do not count across. On a sphere of radius R the
fit over a radius r is too large by r²/4R² of itself (h = ρ²/2R + ρ⁴/8R³, and over a disc ρ⁴ is fitted by r²ρ² - r⁴/6);
noise of the vertices enters with 1/r².

Triangles cut across what they were made from: a sphere of radius R is up to h^2/8R above the middle of an edge h. Where
corners lie on the smooth surface and its normals there are known, the surface is, to second order, the mean of the
triangle and of its corners' tangent planes as Phong tessellation blends them (Boubekeur and Alexa 2008, ACM TOG 27(5),
141; their shape factor is 3/4 for looks, 1/2 is what reproduces a quadratic surface).
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from geocontact.geometry.surface import Surface

CREASE = np.cos(np.radians(35.0))
"""Faces that turn by more than this at an edge meet at an edge of the part: nothing bulges across it."""


def corner_normals(surface: Surface) -> Float[np.ndarray, "m 3 3"]:
    """Unit normal of the smooth surface at each corner of each face, creases kept.

    Faces around a vertex that turn from the face in question by no more than 35 degrees are taken together with the
    weights of Max (1999), Journal of Graphics Tools 4(2), 1, which are exact for corners on a sphere.
    """
    faces, corners = surface.faces, surface.corners
    ahead, behind = (np.roll(corners, shift, axis=1) - corners for shift in (-1, 1))
    sizes = np.einsum("fki,fki->fk", ahead, ahead) * np.einsum("fki,fki->fk", behind, behind)
    sign = -1.0 if surface.inside_out else 1.0
    own = sign * np.cross(ahead, behind) / np.maximum(sizes, 1e-300)[:, :, None]
    vertex = surface.topology.merged[faces].ravel()
    order = np.argsort(vertex, kind="stable")
    first = np.searchsorted(vertex[order], vertex)
    count = np.bincount(vertex)[vertex]
    normal = np.repeat(surface.face_normal, 3, axis=0)
    total = np.zeros_like(normal)
    for k in range(int(count.max(initial=0))):
        here = np.flatnonzero(count > k)
        other = order[first[here] + k]
        smooth = np.einsum("ni,ni->n", normal[here], normal[other]) >= CREASE
        total[here[smooth]] += own.reshape(-1, 3)[other[smooth]]
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(size > 0.0, total / np.maximum(size, 1e-300), normal).reshape(-1, 3, 3)


def phong_offset(
    surface: Surface,
    normals: Float[np.ndarray, "m 3 3"],
    face: Int[np.ndarray, " n"],
    points: Float[np.ndarray, "n 3"],
) -> Float[np.ndarray, " n"]:
    """Height of the smooth surface above points on its triangles, outwards [m]; negative in a hollow.

    Parameters
    ----------
    normals
        `corner_normals`.
    face, points
        Points on faces, in the surface's frame [m].
    """
    to_corner = surface.corners_of(face) - (points - surface.centre)[:, None, :]
    height = np.einsum("nki,nki->nk", to_corner, normals[face])
    return np.asarray(0.5 * np.einsum("nk,nk->n", corner_shares(to_corner), height))


def phong_slope(
    surface: Surface,
    normals: Float[np.ndarray, "m 3 3"],
    face: Int[np.ndarray, " n"],
    points: Float[np.ndarray, "n 3"],
) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3 3"]]:
    """First and second derivative of `phong_offset` to the place within the triangle [-] and [1/m].

    The offset is quadratic in each triangle, so that the second one is the same everywhere in it.
    """
    corners = surface.corners_of(face)
    to_corner = corners - (points - surface.centre)[:, None, :]
    opposite = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    twice = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    square = np.maximum(np.einsum("ni,ni->n", twice, twice), 1e-300)
    share = np.cross(twice[:, None, :], opposite) / square[:, None, None]  # slope of each barycentric coordinate
    across = np.eye(3) - twice[:, :, None] * twice[:, None, :] / square[:, None, None]
    inside = np.einsum("nij,nkj->nki", across, normals[face])  # the part of the normals within the triangle
    height = np.einsum("nki,nki->nk", to_corner, normals[face])
    shares = corner_shares(to_corner)
    slope = 0.5 * (np.einsum("nki,nk->ni", share, height) - np.einsum("nk,nki->ni", shares, inside))
    bend = -0.5 * np.einsum("nki,nkj->nij", share, inside)
    return np.asarray(slope), np.asarray(bend + np.swapaxes(bend, 1, 2))


def corner_shares(to_corner: Float[np.ndarray, "n 3 3"]) -> Float[np.ndarray, "n 3"]:
    """Barycentric coordinates from the vectors to the corners: areas of the triangles opposite to each."""
    opposite = np.cross(np.roll(to_corner, -1, axis=1), np.roll(to_corner, 1, axis=1))
    whole = opposite.sum(axis=1)
    size = np.maximum(np.einsum("ni,ni->n", whole, whole), 1e-300)
    return np.asarray(np.clip(np.einsum("nki,ni->nk", opposite, whole) / size[:, None], 0.0, 1.0))


BLOCK = 2000
"""Vertices that are fitted together: what is needed meanwhile stays small."""
SAME_SIDE = 0.5
"""Cosine of the angle between normals from which a vertex counts as a neighbour."""
ROUND = 1e-5
"""Smallest eigenvalue of the mean of the fit's squares (lengths over the radius) from which neighbours tell it."""


def vertex_normals(surface: Surface) -> Float[np.ndarray, "n 3"]:
    """Unit normals of the vertices, outwards where the surface is closed, faces weighted by area; zero without one."""
    total = np.zeros((len(surface.vertices), 3))
    weighted = surface.face_normal * surface.face_area[:, None]
    for corner in surface.topology.merged[surface.faces].T:
        np.add.at(total, corner, weighted)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    unit = np.divide(total, length, out=np.zeros_like(total), where=length > 0.0)
    return np.asarray(unit[surface.topology.merged])


class Curvatures:
    """Curvatures of one surface, fitted within `radius` [m] as far as vertices are asked for.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> from geocontact.geometry.curvature import Curvatures
    >>> ball = gc.read_surface("meshes/sphere_r20.stl", "mm")
    >>> found = Curvatures(ball, radius=4e-3).tensors(np.arange(3))
    >>> np.round(np.linalg.eigvalsh(found)[:, 1:], 0).tolist()
    [[50.0, 50.0], [50.0, 50.0], [50.0, 50.0]]
    """

    def __init__(self, surface: Surface, radius: float) -> None:
        self.normals = vertex_normals(surface)
        self._radius = radius
        self._places = np.unique(surface.topology.merged[surface.faces])
        self._vertices, self._merged = surface.local, surface.topology.merged
        self._tree = cKDTree(surface.local[self._places])
        self._found = np.full((len(surface.vertices), 3, 3), np.nan)
        self._asked = np.zeros(len(surface.vertices), bool)

    def tensors(self, vertices: Int[np.ndarray, " k"]) -> Float[np.ndarray, "k 3 3"]:
        """Curvature tensor at vertices [1/m]: t·T t is the normal curvature along a unit tangent t.

        Positive where the surface is convex seen from outside; zero along the normal. NaN where the neighbours are too
        few, or lie so that they tell no quadratic.
        """
        wanted = self._merged[vertices]
        new = np.unique(wanted[~self._asked[wanted]])
        for first in range(0, len(new), BLOCK):
            block = new[first : first + BLOCK]
            self._found[block] = self._fitted(block)
        self._asked[new] = True
        return np.asarray(self._found[wanted])

    def _fitted(self, at: Int[np.ndarray, " k"]) -> Float[np.ndarray, "k 3 3"]:
        lists = self._tree.query_ball_point(self._vertices[at], self._radius)
        owner = np.repeat(np.arange(len(at)), [len(each) for each in lists])
        other = self._places[np.concatenate(lists).astype(np.int64)]
        beside = np.einsum("ni,ni->n", self.normals[at][owner], self.normals[other]) > SAME_SIDE
        owner, other = owner[beside], other[beside]
        frames = _frames(self.normals[at])
        offset = (self._vertices[other] - self._vertices[at][owner]) / self._radius
        u, v, height = np.einsum("nij,nj->in", frames[owner], offset)
        rows = np.column_stack([np.ones_like(u), u, v, 0.5 * u * u, u * v, 0.5 * v * v])
        squares = _summed(rows[:, :, None] * rows[:, None, :], owner, len(at))
        sides = _summed(rows * height[:, None], owner, len(at))
        count = np.bincount(owner, minlength=len(at))
        told = np.linalg.eigvalsh(squares)[:, 0] > ROUND * count
        out = np.full((len(at), 3, 3), np.nan)
        fit = np.linalg.solve(squares[told], sides[told][:, :, None])[:, :, 0]
        out[told] = _tensors(fit, frames[told]) / self._radius
        return out


def _frames(normal: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "k 3 3"]:
    """Two unit vectors at right angles to each unit normal, and the normal, as rows."""
    least = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, least)
    length = np.linalg.norm(first, axis=1, keepdims=True)
    first = np.divide(first, length, out=np.zeros_like(first), where=length > 0.0)
    return np.stack([first, np.cross(normal, first), normal], axis=1)


def _summed(values: np.ndarray, owner: Int[np.ndarray, " n"], count: int) -> np.ndarray:
    """Sums of rows with the same owner; owners rise."""
    total = np.zeros((count, *values.shape[1:]))
    np.add.at(total, owner, values)
    return total


def _tensors(fit: Float[np.ndarray, "k 6"], frames: Float[np.ndarray, "k 3 3"]) -> Float[np.ndarray, "k 3 3"]:
    """Tensors of graphs h(u, v) at their middle, convex positive.

    With r_u = (1, 0, d), r_v = (0, 1, e) the second fundamental form is the Hessian over sqrt(1 + d² + e²) (do Carmo
    1976, sec. 3-3); the pseudo-inverse of (r_u, r_v) makes a tensor of it that asks for no coordinates.
    """
    _, d, e, a, b, c = fit.T
    one, zero = np.ones_like(d), np.zeros_like(d)
    tangents = np.stack([np.stack([one, zero, d], axis=1), np.stack([zero, one, e], axis=1)], axis=1)
    hessian = np.stack([np.stack([a, b], axis=1), np.stack([b, c], axis=1)], axis=1)
    back = np.linalg.pinv(tangents.transpose(0, 2, 1)) @ frames
    form = -hessian / np.sqrt(1.0 + d * d + e * e)[:, None, None]
    return np.asarray(back.transpose(0, 2, 1) @ form @ back)
