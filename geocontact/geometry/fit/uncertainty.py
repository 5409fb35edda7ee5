"""How well the parameters of a fit are known when neighbouring points err alike.

A surface is not a cylinder plus independent noise: where it departs from one, all points nearby depart together, and
an interval that counts them as independent shrinks with every refinement of the mesh. Points are therefore grouped into
compact cells, and the covariance is that of leaving out one cell after the other (delete-one-cluster jackknife of the
linearised M-estimator; Bell and McCaffrey 2002, Survey Methodology 28, 169-181, their estimator CR3):

    d_g = (A - A_g)^-1 s_g,   cov = (G - 1) / G  sum_g (d_g - mean d) (d_g - mean d)^T

with s_g = sum psi(r_i) J_i and A_g = sum psi'(r_i) J_i J_i^T over the points of cell g. It holds as long as errors are
alike over distances smaller than a cell, a quarter of the patch. Few points are their own cells and independent.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int
from scipy.special import stdtrit

LEVELS = 4  # halvings: 16 cells
POINTS = 16  # a cell holds at least; with fewer in all every point is one


def cells(points: Float[np.ndarray, "n 3"]) -> Int[np.ndarray, " n"]:
    """Number of the cell of each point: halved at the median of the longest side, four times."""
    if len(points) < POINTS * 2**LEVELS:
        return np.arange(len(points))
    found = np.zeros(len(points), np.int64)
    groups = [np.arange(len(points))]
    for _ in range(LEVELS):
        groups = [half for group in groups for half in _halves(points, group)]
    for number, group in enumerate(groups):
        found[group] = number
    return found


def _halves(points: Float[np.ndarray, "n 3"], group: Int[np.ndarray, " k"]) -> tuple[np.ndarray, np.ndarray]:
    own = points[group]
    order = np.argpartition(own[:, int(np.argmax(np.ptp(own, axis=0)))], len(group) // 2)
    return group[order[: len(group) // 2]], group[order[len(group) // 2 :]]


def covariance(
    residual: Float[np.ndarray, " n"],
    jacobian: Float[np.ndarray, "n p"],
    scale: float | None,
    cell: Int[np.ndarray, " n"],
) -> Float[np.ndarray, "p p"]:
    """Covariance of the parameters; `scale` is that of the biweight, None for least squares.

    Infinite where the points do not determine the parameters.
    """
    square = (residual / (scale or np.inf)) ** 2
    left = np.maximum(1.0 - square, 0.0)
    pull, slope = left**2 * residual, left * (1.0 - 5.0 * square)
    count = int(cell.max()) + 1
    score = np.stack([np.bincount(cell, pull * column, count) for column in jacobian.T], axis=1)
    p = jacobian.shape[1]
    bread = np.empty((count, p, p))
    for j in range(p):
        for k in range(j, p):
            bread[:, j, k] = bread[:, k, j] = np.bincount(cell, slope * jacobian[:, j] * jacobian[:, k], count)
    whole = bread.sum(axis=0)
    if count <= p or not np.linalg.cond(whole) < 1.0 / np.finfo(float).eps:
        return np.full((p, p), np.inf)
    moved = np.linalg.solve(whole - bread, score[:, :, None])[:, :, 0]
    moved -= moved.mean(axis=0)
    return np.asarray((count - 1.0) / count * moved.T @ moved)


def half_width(variance: float, cell: Int[np.ndarray, " n"], parameters: int) -> float:
    """Half the 95 % interval of a parameter of that variance: Student's t with the cells' degrees of freedom."""
    count = int(cell.max()) + 1
    free = count - 1 if count < len(cell) else count - parameters
    if free < 1 or not np.isfinite(variance):
        return float(np.inf)
    return float(stdtrit(free, 0.975) * np.sqrt(variance))
