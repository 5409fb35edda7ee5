"""Where a mat lies on a body, found from a scan with it and one without: the region that stands off."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from geocontact.geometry.surface import Surface

THIN, THICK = 1e-3, 1e-2  # m, of mats
NORMAL = 1.4826  # standard deviation of normal deviations over their median size
CLEAR = 3.0  # standard deviations of the scan's noise that a region stands off by at least
ROUNDS = 4


@dataclass(frozen=True, eq=False)
class ScanDifference:
    """The largest region of one scan that stands off another.

    Parameters
    ----------
    thickness
        Median height of the region [m].
    noise
        Standard deviation of the heights elsewhere [m].
    area
        Of the region, at half its height [m^2].
    outline
        Middles of the pieces of its edge at half the thickness, laid down onto the other scan [m].
    length
        Of each piece [m].
    """

    thickness: float
    noise: float
    area: float
    outline: Float[np.ndarray, "n 3"]
    length: Float[np.ndarray, " n"]


def scan_difference(with_mat: Surface, bare: Surface) -> ScanDifference:
    """The mat on a scan that lies in the frame of the bare one.

    Heights of the vertices over the bare scan are signed by its faces. Of all that is higher than half the thickness
    the largest connected piece counts; thickness and piece are found in turns. A step that a scanner rounds off, or
    that is one triangle wide, is crossed at half height about where the mat ends.
    """
    found = bare.proximity(with_mat.vertices)
    off = with_mat.vertices - found.closest
    sign = np.where(np.einsum("ij,ij->i", off, bare.face_normal[found.face]) < 0.0, -1.0, 1.0)
    height = sign * np.abs(found.distance)
    noise = NORMAL * float(np.median(np.abs(height - np.median(height))))
    level, thickness = max(0.5 * THIN, CLEAR * noise), 0.0
    faces = with_mat.topology.merged[with_mat.faces]
    for _ in range(ROUNDS):
        inside = _largest(with_mat, faces, (height > level) & (height < 1.5 * THICK))
        if not inside.any():
            raise ValueError(
                f"nothing on {with_mat.name} stands off {bare.name} by {level * 1e3:.1f} mm or more; is the mat on it?"
            )
        weight = np.bincount(with_mat.faces.ravel(), np.repeat(with_mat.face_area / 3.0, 3), len(height)) * inside
        thickness = _median(height[inside], weight[inside])
        level = 0.5 * thickness
    if not THIN <= thickness <= THICK:
        raise ValueError(
            f"what stands off {bare.name} is {thickness * 1e3:.1f} mm high, and a mat {THIN * 1e3:g} to "
            f"{THICK * 1e3:g} mm"
        )
    points, length = _edge(with_mat, faces, height - level, inside)
    ground = bare.proximity(points).closest
    whole = inside[with_mat.faces].all(axis=1)
    return ScanDifference(thickness, noise, float(with_mat.face_area[whole].sum()), ground, length)


def _largest(surface: Surface, faces: np.ndarray, high: Bool[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
    """Vertices of the connected piece of faces with high corners that has the largest area."""
    whole = high[surface.faces].all(axis=1)
    if not whole.any():
        return np.zeros(len(high), bool)
    own = faces[whole]
    start, goal = own.ravel(), own[:, [1, 2, 0]].ravel()
    graph = coo_array((np.ones(len(start)), (start, goal)), shape=(len(high), len(high)))
    _, piece = connected_components(graph, directed=False)
    area = np.bincount(piece[own[:, 0]], surface.face_area[whole], piece.max() + 1)
    return np.asarray((piece == int(np.argmax(area)))[surface.topology.merged] & high)


def _median(values: Float[np.ndarray, " n"], weight: Float[np.ndarray, " n"]) -> float:
    order = np.argsort(values)
    total = np.cumsum(weight[order])
    return float(values[order][int(np.searchsorted(total, 0.5 * total[-1]))])


def _edge(
    surface: Surface, faces: np.ndarray, over: Float[np.ndarray, " n"], inside: Bool[np.ndarray, " n"]
) -> tuple[Float[np.ndarray, "k 3"], Float[np.ndarray, " k"]]:
    """Middles and lengths of the pieces in which the faces at the region's edge are crossed at zero."""
    corner = surface.faces
    some = inside[corner].any(axis=1) & (over[corner] <= 0.0).any(axis=1)
    corner = corner[some]
    ends = []
    for a, b in ((0, 1), (1, 2), (2, 0)):
        i, j = corner[:, a], corner[:, b]
        crossed = (over[i] > 0.0) != (over[j] > 0.0)
        share = np.where(crossed, over[i] / np.where(crossed, over[i] - over[j], 1.0), np.nan)
        ends.append(surface.vertices[i] + share[:, None] * (surface.vertices[j] - surface.vertices[i]))
    points = np.stack(ends, axis=1)
    two = np.isfinite(points[..., 0]).sum(axis=1) == 2
    points = points[two]
    pairs = points[np.isfinite(points[..., 0])].reshape(-1, 2, 3)
    length = np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1)
    return pairs.mean(axis=1), length
