"""Where points lie along a foot, from the heel: in metres and as a share of the foot's length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.loads.sphere_set import SphereSet


@dataclass(frozen=True)
class FootAxis:
    """From the heel to the toe.

    Parameters
    ----------
    direction
        Unit vector towards the toe in the foot's frame.
    heel
        Place of the heel along it, from the origin of the foot's frame [m].
    length
        Of the foot [m].
    """

    direction: Float[np.ndarray, " 3"]
    heel: float
    length: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.length) and self.length > 0.0):
            raise ValueError("the length of a foot must be positive")

    def from_heel(self, points: Float[np.ndarray, "t 3"], poses: RigidTransform) -> Float[np.ndarray, " t"]:
        """Distance from the heel along the foot [m] of points in the frame of the ground; NaN stays NaN.

        `poses` are those of the foot in the ground's frame, one per point.
        """
        turn = poses.rotation.as_matrix().reshape(-1, 3, 3)
        offset = points - poses.translation.reshape(-1, 3)
        return np.asarray(np.einsum("ti,tij,j->t", offset, turn, self.direction) - self.heel)

    def share(self, distance: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Distance from the heel over the length of the foot: 0 at the heel, 1 at the tip of the toe."""
        return distance / self.length


def axis_of_sole(spheres: SphereSet, direction: Float[np.ndarray, " 3"], length: float | None = None) -> FootAxis:
    """The heel is the rearmost point of any sphere; the length [m] is the way to the foremost unless given."""
    along = direction / np.linalg.norm(direction)
    place = spheres.centre @ along
    heel = float((place - spheres.radius).min())
    return FootAxis(along, heel, float((place + spheres.radius).max()) - heel if length is None else length)
