"""Positions on a laid mat, counted in cells: where they are, and which way rows and columns run there."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.drape.geodesics import SurfacePoints


def corners_at(
    shape: tuple[int, ...], cells: Float[np.ndarray, "k 2"]
) -> tuple[Int[np.ndarray, "k 4"], Float[np.ndarray, "k 4"]]:
    """Corners of the cell that each position lies in (flat indices of nodes of `shape`), and their bilinear shares."""
    low, (s, t) = _in_cell(shape, cells)
    first = low @ np.array([shape[1], 1])
    index = np.stack([first, first + shape[1], first + 1, first + shape[1] + 1], axis=1)
    return index, np.stack([(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t], axis=1)


def between(nodes: SurfacePoints, cells: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "k 3"]:
    """Points at positions counted in cells [m], linear between the corners of their cell; NaN where it is not there."""
    index, share = corners_at(nodes.face.shape, cells)
    corners = nodes.point.reshape(-1, 3)[index]
    return np.asarray(np.where(share[..., None] > 0.0, share[..., None] * corners, 0.0).sum(axis=1))


def directions(points: Float[np.ndarray, "r1 c1 3"], cells: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "k 2 3"]:
    """Unit directions of increasing row and of increasing column at positions counted in cells; NaN off the surface.

    By differences of the corners, of second order also at the ends of the mat; beside corners that are off the surface
    by the sides of the position's own cell.
    """
    index, share = corners_at(points.shape, cells)
    smooth = np.stack([_slope(points, k).reshape(-1, 3)[index] for k in (0, 1)], axis=1)
    ways = np.where(share[:, None, :, None] > 0.0, share[:, None, :, None] * smooth, 0.0).sum(axis=2)
    _, (s, t) = _in_cell(points.shape, cells)
    a, b, c, d = points.reshape(-1, 3)[index].transpose(1, 0, 2)
    s, t = s[:, None], t[:, None]
    own = np.stack([(1.0 - t) * (b - a) + t * (d - c), (1.0 - s) * (c - a) + s * (d - b)], axis=1)
    ways = np.where(np.isfinite(ways).all(axis=(1, 2))[:, None, None], ways, own)
    return np.asarray(ways / np.linalg.norm(ways, axis=2, keepdims=True))


def _slope(points: Float[np.ndarray, "r1 c1 3"], axis: int) -> Float[np.ndarray, "r1 c1 3"]:
    """Change of the corners from one to the next [m]."""
    return np.asarray(np.gradient(points, axis=axis, edge_order=2 if points.shape[axis] > 2 else 1))


def _in_cell(
    shape: tuple[int, ...], cells: Float[np.ndarray, "k 2"]
) -> tuple[Int[np.ndarray, "k 2"], Float[np.ndarray, "2 k"]]:
    """First corner (row, column) of the cell that each position lies in, and how far in it is along both."""
    low = np.clip(np.floor(cells).astype(np.int64), 0, np.array(shape[:2]) - 2)
    return low, (cells - low).T
