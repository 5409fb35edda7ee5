"""Polygons of a file to triangles."""

from __future__ import annotations

import warnings

import numpy as np
from jaxtyping import Int

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mesh import limits


def triangles(
    corners: Int[np.ndarray, " k"], sizes: Int[np.ndarray, " p"], vertex_count: int, file: str
) -> Int[np.ndarray, "m 3"]:
    """Fan triangles of polygons, polygon after polygon, each from its first corner.

    Triangles stay as they are: then triangle i is face i of the file. A polygon of n corners becomes n − 2
    consecutive triangles (warned about: the numbers of later faces move, and a concave polygon comes out wrong).

    Parameters
    ----------
    corners
        Vertex indices of all polygons, one polygon after the other, 0-based.
    sizes
        Number of corners of each polygon; 3 at least, else refused.
    vertex_count
        Vertices there are; an index outside 0 … vertex_count − 1 is refused.
    """
    _require_valid(corners, sizes, vertex_count, file)
    split = int(np.count_nonzero(sizes > 3))
    if split == 0:
        return corners.reshape(-1, 3)
    each = sizes - 2
    limits.require_count(int(each.sum()), limits.MAX_FACES, "faces", file)
    first = np.repeat(np.cumsum(sizes) - sizes, each)
    step = np.arange(len(first)) - np.repeat(np.cumsum(each) - each, each)
    noun = "polygon" if split == 1 else "polygons"
    message = f"{file}: {split} {noun} with more than 3 corners cut into triangles; face numbers count triangles"
    warnings.warn(InputWarning(message), stacklevel=2)
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)


def _require_valid(corners: Int[np.ndarray, " k"], sizes: Int[np.ndarray, " p"], vertex_count: int, file: str) -> None:
    limits.require_count(len(sizes), limits.MAX_FACES, "faces", file)
    if sizes.min() < 3:
        face = int(np.argmax(sizes < 3))
        raise InputError(file, f"face {face}", f"has {sizes[face]} corners, 3 are needed", "export it again")
    bad = (corners < 0) | (corners >= vertex_count)
    if bad.any():
        corner = int(np.argmax(bad))
        face = int(np.searchsorted(np.cumsum(sizes), corner, side="right"))
        what = f"vertex index {corners[corner]} is outside 0 to {vertex_count - 1}"
        raise InputError(file, f"face {face}", what, "the file is damaged, export it again")
