"""Collocation points of one interval and what polynomials through them do.

States are polynomials of degree d through the interval's start and its d points, controls of degree d - 1 through the
points. Radau's points (IIA) end with the interval and leave its start out; Legendre's leave out both ends. At the
nodes the error falls with the power 2 d - 1 and 2 d of the interval (Hairer & Wanner (1996), Solving ODEs II, IV.5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

Matrix = Float[np.ndarray, "_ _"]
KINDS = ("radau", "legendre")


@dataclass(frozen=True)
class Scheme:
    """Points of the unit interval.

    Parameters
    ----------
    kind
        radau or legendre.
    points
        In (0, 1], d of them.
    derivative
        Of the state's polynomial at the points, per length of the interval, of its values at 0 and the points.
    weights
        Of the points in the integral over the interval.
    """

    kind: str
    points: Float[np.ndarray, " d"]
    derivative: Float[np.ndarray, "d d1"]
    weights: Float[np.ndarray, " d"]

    @property
    def degree(self) -> int:
        """Number of points."""
        return len(self.points)

    def of_states(self, where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s d1"]:
        """Weights of the values at 0 and the points in the state at some places of the interval."""
        return _lagrange(np.r_[0.0, self.points], where)

    def of_controls(self, where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s d"]:
        """Weights of the values at the points in a control there."""
        return _lagrange(self.points, where)

    def of_rates(self, where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s d1"]:
        """Weights in the state's derivative there, per length of the interval: it has the controls' degree."""
        weights: Matrix = self.of_controls(where) @ self.derivative
        return weights


def scheme(kind: str, degree: int) -> Scheme:
    """Radau or Legendre points, 1 to 9 of them. ValueError for others."""
    from casadi import collocation_points

    if kind not in KINDS or not 1 <= degree <= 9:
        raise ValueError(f"collocation is {' or '.join(KINDS)} of degree 1 to 9, not {kind} of degree {degree}")
    points = np.array(collocation_points(degree, kind))
    nodes = np.r_[0.0, points]
    powers = np.arange(degree + 1)
    values = np.vander(nodes, increasing=True)
    slopes = np.where(powers > 0, powers * points[:, None] ** np.maximum(powers - 1, 0), 0.0)
    derivative = np.linalg.solve(values.T, slopes.T).T
    weights = np.linalg.solve(np.vander(points, increasing=True).T, 1.0 / (powers[:-1] + 1.0))
    return Scheme(kind, points, derivative, weights)


def _lagrange(nodes: Float[np.ndarray, " n"], where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s n"]:
    columns = []
    for i, node in enumerate(nodes):
        others = np.delete(nodes, i)
        columns.append(np.prod((where[:, None] - others) / (node - others), axis=1))
    return np.stack(columns, axis=1)
