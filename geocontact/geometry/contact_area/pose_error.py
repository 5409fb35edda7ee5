"""Contact area when the pose is known with an error: drawn, and to first order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.geometry.contact_area.repeated import RepeatedArea
from geocontact.geometry.register.landmarks import fit_landmarks

Axes = Literal["fixed", "moving"]


@dataclass(frozen=True, eq=False)
class PoseError:
    """Small motions by which a pose may be off.

    Parameters
    ----------
    draws
        Shift [m] and turn [rad, a rotation vector] of each draw.
    matrix
        Their covariance to first order.
    axes
        fixed: along FIXED's axes, x = exp(turn) R a + t + shift, turned about MOVING's origin. moving: along MOVING's,
        x = R (exp(turn) a + shift) + t.
    """

    draws: Float[np.ndarray, "n 6"]
    matrix: Float[np.ndarray, "6 6"]
    axes: Axes

    @classmethod
    def normal(cls, sd: Float[np.ndarray, " 6"], axes: Axes, count: int, seed: int) -> PoseError:
        """Independent normal errors with these standard deviations [m, rad]."""
        draws = np.random.default_rng(seed).standard_normal((count, 6)) * sd
        return cls(draws, np.diag(sd**2), axes)

    @classmethod
    def of_markers(cls, markers: Float[np.ndarray, "m 3"], sd: float, count: int, seed: int) -> PoseError:
        """What normal errors of markers on MOVING [m, in its frame, each coordinate] do to a rigid fit of them.

        Each draw is a fit (`register.landmarks`). The covariance is that of the fit to first order (Sibson 1979):
        sd^2/m for the shift of the centroid, sd^2 (sum (|r|^2 I - r r^t))^-1 for the turn.
        """
        noise = np.random.default_rng(seed).standard_normal((count, *markers.shape)) * sd
        poses = [fit_landmarks(markers, markers + each).pose for each in noise]
        draws = np.array([[*pose.translation, *pose.rotation.as_rotvec()] for pose in poses])
        about = markers.mean(axis=0)
        arm = markers - about
        inertia = np.eye(3) * float((arm**2).sum()) - arm.T @ arm
        turn = sd**2 * np.linalg.inv(inertia)
        carried = np.array([np.cross(about, axis) for axis in np.eye(3)]).T  # shift of the origin = about x turn
        matrix = np.zeros((6, 6))
        matrix[:3, :3] = sd**2 / len(markers) * np.eye(3) + carried @ turn @ carried.T
        matrix[:3, 3:] = carried @ turn
        matrix[3:, :3] = matrix[:3, 3:].T
        matrix[3:, 3:] = turn
        return cls(draws, matrix, "moving")

    def poses(
        self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
    ) -> tuple[Float[np.ndarray, "n 3 3"], Float[np.ndarray, "n 3"]]:
        """The pose moved by each draw."""
        turns, shifts = Rotation.from_rotvec(self.draws[:, 3:]).as_matrix(), self.draws[:, :3]
        if self.axes == "fixed":
            return turns @ rotation, translation + shifts
        return rotation @ turns, translation + shifts @ rotation.T


@dataclass(frozen=True, eq=False)
class ErrorOfArea:
    """FIXED's area over the draws at one pose [m^2], triangles cut as given.

    nominal is the area at the pose itself, drawn (n,) those of the draws; slope (6,) is the derivative to shift [m] and
    turn [rad] of the error's own axes; first_order the standard deviation that follows from it.
    """

    nominal: float
    drawn: Float[np.ndarray, " n"]
    slope: Float[np.ndarray, " 6"]
    first_order: float


def error_of_area(
    areas: RepeatedArea,
    error: PoseError,
    rotation: Float[np.ndarray, "3 3"],
    translation: Float[np.ndarray, " 3"],
    workers: int | None = None,
) -> ErrorOfArea:
    """Both at one pose of MOVING; `areas` measures FIXED in the field of MOVING.

    A small motion (shift, turn) of MOVING along its own axes moves FIXED by its opposite, in MOVING's frame and about
    MOVING's origin; so do errors along FIXED's axes, after a turn into MOVING's.
    """
    turned, shifted = error.poses(rotation, translation)
    every, at = np.concatenate([rotation[None], turned]), np.concatenate([translation[None], shifted])
    back = every.transpose(0, 2, 1)
    found = areas.at(back, -np.einsum("nij,nj->ni", back, at), workers)
    slope = -found.slope[0]
    if error.axes == "fixed":
        slope = np.concatenate([rotation @ slope[:3], rotation @ slope[3:]])
    variance = float(slope @ error.matrix @ slope)
    return ErrorOfArea(float(found.area[0]), found.area[1:], slope, float(np.sqrt(max(variance, 0.0))))
