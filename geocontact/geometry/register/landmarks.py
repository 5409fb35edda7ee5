"""Rigid fit of points that were named on both bodies, and poses of a segment between the recorded times."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from geocontact.geometry.register.quality import Registration, landmark_covariance

FLAT = 1e-3  # spread across the line of the landmarks over that along it, below which they leave a turn open
TOLERANCE = 5e-3  # m; hand-placed landmarks on skin


def fit_landmarks(
    moving: Float[np.ndarray, "n 3"],
    fixed: Float[np.ndarray, "n 3"],
    weights: Float[np.ndarray, " n"] | None = None,
    names: Sequence[str] = (),
    tolerance: float = TOLERANCE,
) -> Registration:
    """The pose that brings landmarks of A nearest to the same ones of B, in the least-squares sense.

    Minimises sum w |R a + t - b|^2 (Kabsch 1976; Horn 1987): t joins the weighted centroids, R aligns the arms about
    them and never mirrors. With the same random error of variance s^2 per coordinate in all points of A the expected
    mean square residual is 3 s^2 (1 - 2/n) (Sibson 1979; Fitzpatrick, West and Maurer 1998).

    Parameters
    ----------
    moving, fixed
        Landmarks of A and of B in the same order [m].
    weights
        Of each, not negative; all the same if not given.
    names
        For the report; numbered if not given.
    tolerance
        Residual within which a landmark counts as met [m].
    """
    n = len(moving)
    weight = np.ones(n) if weights is None else weights
    names = tuple(names) or tuple(f"landmark {k + 1}" for k in range(n))
    if len(names) != n:
        raise ValueError(f"{n} landmarks but {len(names)} names")
    if not (np.isfinite(moving).all() and np.isfinite(fixed).all()):
        raise ValueError(f"{_first_not_finite(moving, fixed, names)} is not finite; leave it out on both sides")
    if not np.isfinite(weight).all() or (weight < 0.0).any():
        raise ValueError("weights of landmarks must be finite and not negative")
    fix_a_pose(moving[weight > 0.0], "moving")
    fix_a_pose(fixed[weight > 0.0], "fixed")
    pose = fitted_pose(moving, fixed, weight)
    points = pose.apply(moving)
    residual = np.linalg.norm(points - fixed, axis=1)
    return Registration(
        pose, points, residual, tolerance, names, covariance=landmark_covariance(points, residual, weight)
    )


def fitted_pose(
    moving: Float[np.ndarray, "n 3"], fixed: Float[np.ndarray, "n 3"], weight: Float[np.ndarray, " n"]
) -> RigidTransform:
    """The pose of `fit_landmarks` without its checks and its report, for many frames of the same markers."""
    share = weight / weight.sum()
    from_A, from_B = share @ moving, share @ fixed
    R_BA, _ = Rotation.align_vectors(fixed - from_B, moving - from_A, weights=share)
    return RigidTransform.from_components(from_B - R_BA.apply(from_A), R_BA)


def _first_not_finite(moving: Float[np.ndarray, "n 3"], fixed: Float[np.ndarray, "n 3"], names: tuple[str, ...]) -> str:
    return names[int(np.flatnonzero(~np.isfinite(moving + fixed).all(axis=1))[0])]


def fix_a_pose(points: Float[np.ndarray, "n 3"], side: str) -> None:
    """ValueError for landmarks that leave a pose open: fewer than three, or all in one line."""
    if len(points) < 3:
        raise ValueError(f"a pose needs 3 landmarks at least, not {len(points)}")
    along, across = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[:2]
    if not across > FLAT * along:
        raise ValueError(
            f"the {side} landmarks lie in one line, about which the pose is not determined; add one off it"
        )


def poses_at(time: Float[np.ndarray, " t"], poses: RigidTransform, at: Float[np.ndarray, " s"]) -> RigidTransform:
    """Poses X_GB at other times within those recorded [s].

    Rotations turn at constant rate about one axis between neighbours (slerp: Shoemake 1985), the origin of B goes
    straight: exact at the recorded times, the error of second order in the time step between them.
    """
    if len(time) < 2:
        raise ValueError("one pose is not a motion")
    if len(at) and (at.min() < time[0] or at.max() > time[-1]):
        raise ValueError(f"poses are known from {time[0]:g} to {time[-1]:g} s only")
    origin = np.column_stack([np.interp(at, time, poses.translation[:, k]) for k in range(3)])
    return RigidTransform.from_components(origin, Slerp(time, poses.rotation)(at))
