"""A pose that was identified from points or shapes, and how far it may be off by the residual of its landmarks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform


@dataclass(frozen=True, eq=False)
class Registration:
    """Pose of a moving body A in the frame of a fixed one B.

    Parameters
    ----------
    pose
        X_BA: maps points of A into B.
    points
        The points of A that were compared, in B after the move [m].
    residual
        How far each is from its partner or from the surface of B [m], never negative: the residual map.
    tolerance
        Residual within which A and B count as overlapping [m].
    names
        Of the points, where they are landmarks.
    converged
        Whether the search ended by itself; a fit of landmarks needs none.
    rounds
        Of the search.
    hold
        How firmly the shapes hold each other: root mean square change [m] of the distances that fit, for 1 m (or 1 m
        over the points' spread, in rad) of the motion that changes them least. 0: they slide freely (a cylinder in a
        tube); 1: as firmly as a wall. NaN where shapes played no part.
    covariance
        Of the pose, from the residual; None where it was not asked for.
    """

    pose: RigidTransform
    points: Float[np.ndarray, "n 3"]
    residual: Float[np.ndarray, " n"]
    tolerance: float
    names: tuple[str, ...] = ()
    converged: bool = True
    rounds: int = 0
    hold: float = float("nan")
    covariance: PoseCovariance | None = None

    @property
    def rms(self) -> float:
        """Root mean square residual over the points that overlap [m]; over all where these are landmarks."""
        counted = self.residual if self.names else self.residual[self.residual <= self.tolerance]
        return float(np.sqrt(np.mean(counted**2))) if len(counted) else float("nan")

    @property
    def overlap(self) -> float:
        """Share of the points that lie within the tolerance."""
        return float(np.mean(self.residual <= self.tolerance))

    @property
    def worst(self) -> tuple[str, float]:
        """Name (or number) and residual [m] of the point that fits least."""
        k = int(np.argmax(self.residual))
        return self.names[k] if self.names else f"point {k + 1}", float(self.residual[k])


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
