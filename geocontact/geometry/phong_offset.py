"""How far a smooth surface bulges out of the triangles that stand for it.

Triangles cut across what they were made from: a sphere of radius R is up to h^2/8R above the middle of an edge h. Where
corners lie on the smooth surface and its normals there are known, the surface is, to second order, the mean of the
triangle and of its corners' tangent planes as Phong tessellation blends them (Boubekeur and Alexa 2008, ACM TOG 27(5),
141; their shape factor is 3/4 for looks, 1/2 is what reproduces a quadratic surface).
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

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
