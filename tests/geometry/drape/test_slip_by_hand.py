"""How far a laid mat may lie elsewhere beside least squares in loops, the mat bent by a formula."""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np

from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.slip import slip_covariance

MAT = Mat(6, 4, (0.02, 0.015))
R = 0.11
"""m; of the tube that the rows go around."""
CELLS = np.array([[0.0, 0.0], [0.0, 4.0], [6.0, 0.0], [6.0, 4.0], [2.0, 3.0]])


def bent(row: float, column: float) -> np.ndarray:
    """Where a place of the mat is: around a tube along the rows, straight along the columns."""
    angle = (row - 3.0) * 0.02 / R
    return np.array([R * sin(angle), (column - 2.0) * 0.015, R * cos(angle)])


def ways(row: float, column: float) -> list[np.ndarray]:
    """Velocities of three motions: 1 m along the rows, 1 m along the columns, 1 rad about the middle."""
    step = 1e-6
    along, across = (
        (bent(row + step * one, column + step * two) - bent(row - step * one, column - step * two))
        for one, two in ((1, 0), (0, 1))
    )
    along, across = along / sqrt(along @ along), across / sqrt(across @ across)
    ahead, aside = 0.02 * (row - 3.0), 0.015 * (column - 2.0)
    return [along, across, ahead * across - aside * along]


def laid(nodes: np.ndarray, centre: np.ndarray, covered: np.ndarray) -> Drape:
    """A drape of which only these are asked for."""
    shape = covered.shape
    nothing = np.zeros(shape)
    normal = np.zeros((*shape, 3))
    return Drape(nodes, centre, normal, nothing, covered, nothing, np.zeros((*shape, 2)), ~covered, np.zeros(0))


def test_slip_of_a_bent_mat_by_hand() -> None:
    nodes = np.array([[bent(i, j) for j in range(5)] for i in range(7)])
    centre = np.array([[bent(i + 0.5, j + 0.5) for j in range(4)] for i in range(6)])
    covered = np.ones((6, 4), bool)
    covered[5, 1] = False
    rng = np.random.default_rng(7)
    points = np.array([bent(*cell) for cell in CELLS]) + 1e-3 * rng.normal(size=(5, 3))
    squares = 0.0
    normal_matrix = np.zeros((3, 3))
    for cell, point in zip(CELLS, points, strict=True):
        own = ways(*cell)
        miss = point - bent(*cell)
        squares += (miss @ own[0]) ** 2 + (miss @ own[1]) ** 2  # along the tube; across it a mat cannot be elsewhere
        for a in range(3):
            for b in range(3):
                normal_matrix[a, b] += own[a] @ own[b]
    covariance = squares / (2 * 5 - 3) * np.linalg.inv(normal_matrix)
    places = [(i + 0.5, j + 0.5) for i in range(6) for j in range(4) if covered[i, j]]
    about = sum(bent(*place) for place in places) / len(places)
    carried = np.zeros((6, 3))
    for m in range(3):
        # the shift and the turn nearest to the velocities of the cells: Σ |d + w x a - v|² least
        rows, right = [], []
        for place in places:
            x, y, z = bent(*place) - about
            rows += [[1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, x], [0, 0, 1, y, -x, 0]]
            right += list(ways(*place)[m])
        carried[:, m] = np.linalg.lstsq(np.array(rows, float), np.array(right), rcond=None)[0]
    found = slip_covariance(MAT, laid(nodes, centre, covered), Marks(CELLS, points))
    assert found is not None and found.freedom == 7.0
    np.testing.assert_allclose(found.about, about, atol=1e-12)
    # directions are differences of corners, of second order: 0.02 m on 0.11 m
    wanted = carried @ covariance @ carried.T
    scale = np.sqrt(np.diag(wanted))
    np.testing.assert_allclose(found.matrix / np.outer(scale, scale), wanted / np.outer(scale, scale), atol=0.02)
