"""One vertex for all at the same place: to the last bit, or within a tolerance that is asked for."""

from __future__ import annotations

import warnings

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.mesh import first_of_coincident
from geocontact.io.mesh.mesh_checks import degenerate


def merge_coincident(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], file: str
) -> tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "m 3"]]:
    """One vertex for all that are equal to the last bit; −0 equals 0.

    Faces keep their order and corners, vertices the order in which they first appear. Vertices that no face uses are
    left out with a warning. `vertices` must be finite.
    """
    vertices = vertices + vertices.dtype.type(0)  # −0 + 0 is +0
    representative = first_of_coincident(vertices)
    used = np.zeros(len(vertices), dtype=bool)
    used[representative[faces]] = True
    distinct = np.count_nonzero(representative == np.arange(len(vertices)))
    unused = int(distinct - np.count_nonzero(used))
    if unused:
        noun = "vertices belong" if unused > 1 else "vertex belongs"
        warnings.warn(InputWarning(f"{file}: {unused} {noun} to no face, left out"), stacklevel=3)
    number = np.cumsum(used, dtype=np.int32) - 1
    return vertices[used], number[representative][faces].astype(np.int64)


def merge_close(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], tolerance: float, scale: float, file: str
) -> tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "m 3"]]:
    """One vertex, their mean, for all that lie within a tolerance of each other; the others keep all their bits.

    Faces keep their order and corners. How many vertices are merged, and by how much they move at most, is warned
    about, and so is a tolerance within which none lie. The means do not depend on the order of vertices and faces.

    Parameters
    ----------
    vertices, faces
        Those of `merge_coincident`: no two vertices are equal.
    tolerance, scale
        Distance [m], and metres per unit of the vertices.

    Raises
    ------
    InputError
        Corners of a face that has an area lie within the tolerance: the face would collapse. Or vertices hang together
        in a chain whose ends are farther apart than the tolerance: which of them are the same cannot be said.
    """
    points = vertices.astype(np.float64)
    reach = tolerance / scale
    _refuse_collapse(points, faces, reach, scale, file)
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    if not len(pairs):
        message = f"{file}: no two vertices lie within {_mm(tolerance)} mm, `merge_tolerance` has no effect"
        warnings.warn(InputWarning(message), stacklevel=3)
        return vertices, faces
    linked = coo_array((np.ones(len(pairs), np.int8), pairs.T), shape=(len(points), len(points)))
    groups, group = connected_components(linked, directed=False)
    size = np.bincount(group, minlength=groups)
    _refuse_chains(points, pairs, group, size, tolerance, scale, file)
    order = np.lexsort(points.T)
    sums = [np.bincount(group[order], points[order, k], groups) for k in range(3)]
    mean = np.stack(sums, axis=1) / size[:, None]
    close = size[group] > 1
    moved = np.where(close[:, None], mean[group], points)
    shift = float(np.linalg.norm(moved - points, axis=1).max()) * scale
    count = int(np.count_nonzero(close))
    into = int(np.count_nonzero(size > 1))
    message = f"{file}: {count} vertices within {_mm(tolerance)} mm of each other merged into {into}"
    warnings.warn(InputWarning(f"{message}, moved by {_mm(shift)} mm at most"), stacklevel=3)
    return merge_coincident(moved, faces, file)


def _refuse_collapse(
    points: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], reach: float, scale: float, file: str
) -> None:
    """InputError for the shortest edge within reach of a face that has an area."""
    corners = points[faces]
    shortest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).min(axis=1)
    lost = (shortest <= reach) & ~degenerate(points, faces)
    if not lost.any():
        return
    face = int(np.argmin(np.where(lost, shortest, np.inf)))
    count = int(np.count_nonzero(lost))
    what = f"`merge_tolerance` of {_mm(reach * scale)} mm would collapse faces that have an area: {count}"
    what += f", of which this has the shortest edge, {_mm(shortest[face] * scale)} mm"
    raise InputError(file, f"face {face}", what, "give less than that, or remove them from the file")


def _refuse_chains(
    points: Float[np.ndarray, "n 3"],
    pairs: Int[np.ndarray, "p 2"],
    group: Int[np.ndarray, " n"],
    size: Int[np.ndarray, " g"],
    tolerance: float,
    scale: float,
    file: str,
) -> None:
    """InputError for a group in which not each vertex is within the tolerance of each other one."""
    within = np.bincount(group[pairs[:, 0]], minlength=len(size))
    chained = within != size * (size - 1) // 2
    if not chained.any():
        return
    low, high = np.full((len(size), 3), np.inf), np.full((len(size), 3), -np.inf)
    np.minimum.at(low, group, points)
    np.maximum.at(high, group, points)
    span = np.where(chained, np.linalg.norm(high - low, axis=1), 0.0) * scale
    worst = int(np.argmax(span))
    vertex = int(np.argmax(group == worst))
    what = f"{size[worst]} vertices, each within {_mm(tolerance)} mm of a next one, are {_mm(span[worst])} mm across"
    remedy = f"give a `merge_tolerance` above {_mm(span[worst])} mm if they are one corner, a smaller one if not"
    raise InputError(file, f"vertex {vertex}", what, remedy)


def _mm(length: float) -> str:
    return f"{float(length) * 1e3:.3g}"
