"""How far a registered pose may be off, estimated from the residual of what it was found from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class PoseCovariance:
    """Covariance of the small motion of A in B by which its pose X_BA is off.

    Parameters
    ----------
    about
        Point of B that the shift is that of [m].
    matrix
        Of shift [m] and turn [rad], in B.
    freedom
        Degrees of freedom of the residual that it was estimated from: intervals of few landmarks follow Student's t.
    """

    about: Float[np.ndarray, " 3"]
    matrix: Float[np.ndarray, "6 6"]
    freedom: float

    def at(self, point: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "6 6"]:
        """Covariance of the shift of another point of B [m] and the same turn: d + turn x (point - about)."""
        change = np.eye(6)
        change[:3, 3:] = -crossing(point - self.about)
        return np.asarray(change @ self.matrix @ change.T)

    def plus(self, other: PoseCovariance) -> PoseCovariance:
        """With another motion of the same body that is independent of this one, about the same point.

        Degrees of freedom follow Welch (1947) and Satterthwaite (1946), by the mean square of the shift.
        """
        matrices = self.matrix, other.at(self.about)
        own, more = (float(np.trace(each[:3, :3])) for each in matrices)
        inverse = own**2 / self.freedom + more**2 / other.freedom
        freedom = (own + more) ** 2 / inverse if inverse > 0.0 else self.freedom + other.freedom
        return PoseCovariance(self.about, matrices[0] + matrices[1], freedom)


def crossing(vector: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """The matrix [v] with [v] w = v x w."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def landmark_covariance(
    points: Float[np.ndarray, "n 3"], residual: Float[np.ndarray, " n"], weight: Float[np.ndarray, " n"]
) -> PoseCovariance:
    """Covariance of a rigid fit of three landmarks or more.

    With errors of variance s^2/w in every coordinate the shift of the weighted centroid has the covariance s^2/sum w
    and, independent of it, the turn s^2 (sum w (|a|^2 I - a a^t))^-1 with the arms a from the centroid (first order;
    Sibson 1979; the target registration error of Fitzpatrick, West and Maurer 1998 is what follows at a point).
    s^2 is estimated by sum w r^2 / (3 n - 6).

    Parameters
    ----------
    points
        In B, after the move [m].
    residual
        Of each [m].
    """
    used = weight > 0.0
    freedom = 3.0 * int(used.sum()) - 6.0
    about = weight @ points / weight.sum()
    arm = points - about
    inertia = np.eye(3) * float(weight @ (arm**2).sum(axis=1)) - np.einsum("n,ni,nj->ij", weight, arm, arm)
    variance = float(weight @ residual**2) / freedom
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = variance / weight.sum() * np.eye(3)
    matrix[3:, 3:] = variance * np.linalg.inv(inertia)
    return PoseCovariance(about, matrix, freedom)
