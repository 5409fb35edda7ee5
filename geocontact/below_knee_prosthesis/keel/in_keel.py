"""The ground as a keel's own frame sees it: planes under its spheres, its twist, gravity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Ground


@dataclass(frozen=True)
class Planes:
    """Under each sphere in each frame, or one for all: unit normal, and how far along it the plane lies [m]."""

    normal: Float[np.ndarray, "t n 3"]
    level: Float[np.ndarray, "t n"]


def planes_under(ground: Ground, centre: Float[np.ndarray, "t n 3"]) -> Planes:
    """That touch the ground where it is nearest to places."""
    near = ground.proximity(centre.reshape(-1, 3))
    normal = near.normal.reshape(centre.shape)
    return Planes(normal, np.einsum("tni,tni->tn", near.closest.reshape(centre.shape), normal))


def plane_under(ground: HalfSpace, poses: RigidTransform) -> Planes:
    """One for all spheres in each frame."""
    return planes_under(ground, poses.translation.reshape(-1, 1, 3))


@dataclass(frozen=True)
class InKeel:
    """Planes, motion and gravity as the keel's frame sees them, and the frame itself in the ground's."""

    planes: Float[np.ndarray, "t n four"]
    twists: Float[np.ndarray, "t six"]
    gravities: Float[np.ndarray, "t 3"]
    rotation: Float[np.ndarray, "t 3 3"]
    origin: Float[np.ndarray, "t 3"]
    upwards: Float[np.ndarray, "t m 3"]


def seen_by_keel(
    poses: RigidTransform,
    under: Planes,
    gravity: tuple[float, float, float],
    rate: Float[np.ndarray, "t 4 4"] | None,
    spheres: int,
) -> InKeel:
    """Of poses `X_GK`; gravity in the ground's frame [m/s²]; rates of the poses, None where nothing moves.

    One plane for all is turned once, then handed to each of the `spheres`.
    """
    matrices = poses.as_matrix().reshape(-1, 4, 4)
    R, origin = matrices[:, :3, :3], matrices[:, :3, 3]
    heights = np.einsum("ti,tni->tn", origin, under.normal) - under.level
    twists = np.zeros((len(R), 6))
    if rate is not None:
        turning = np.einsum("tji,tjk->tik", R, rate[:, :3, :3])
        turning = 0.5 * (turning - turning.swapaxes(1, 2))
        twists[:, :3] = turning[:, (2, 0, 1), (1, 2, 0)]
        twists[:, 3:] = np.einsum("tji,tj->ti", R, rate[:, :3, 3])
    planes = np.concatenate([np.einsum("tij,tni->tnj", R, under.normal), heights[..., None]], axis=2)
    gravities = np.ascontiguousarray(np.einsum("tij,i->tj", R, np.asarray(gravity, float)))
    planes = np.repeat(planes, spheres // planes.shape[1], axis=1)
    return InKeel(np.ascontiguousarray(planes), twists, gravities, R, origin, under.normal)
