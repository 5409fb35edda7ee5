"""A pose that was found from points or shapes, with everything that tells how good it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.register.uncertainty import PoseCovariance


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
