"""What the ground does to each sphere of a moving foot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.contact.sphere_foot import friction_coefficient, normal_force
from geocontact.loads.ground import Ground
from geocontact.loads.sphere_set import SoleLaw, SphereSet


@dataclass(frozen=True)
class SphereLoads:
    """Loads of the ground on each sphere in each frame, in the ground's frame.

    Parameters
    ----------
    pressing
        Normal force, >= 0 [N].
    force
        Normal force and friction [N]; it acts at `point`.
    point
        Point of the ground nearest to the sphere's centre [m]; NaN where the sphere does not touch.
    centre
        Centre of the sphere [m].
    normal
        Outward normal of the ground there; NaN where the sphere does not touch.
    depth
        Radius - distance of the centre [m]; -inf where the sphere is farther than the largest radius away.
    """

    pressing: Float[np.ndarray, "t n"]
    force: Float[np.ndarray, "t n 3"]
    point: Float[np.ndarray, "t n 3"]
    centre: Float[np.ndarray, "t n 3"]
    normal: Float[np.ndarray, "t n 3"]
    depth: Float[np.ndarray, "t n"]


def sphere_loads(
    spheres: SphereSet,
    law: SoleLaw,
    poses: RigidTransform,
    rate: Float[np.ndarray, "t 4 4"],
    ground: Ground,
) -> SphereLoads:
    """Loads along a motion.

    Depth is radius - distance of the centre, its rate the speed of the centre against the ground's normal. Friction
    acts against the velocity along the ground of that material point of the foot which is the sphere's lowest.

    Parameters
    ----------
    poses, rate
        Poses `X_GF` of the foot in the ground's frame, one per frame, and their time derivative (`pose_rate`).

    A centre deeper in the ground than the largest radius is a ValueError: that is a mistaken frame, not a contact.
    """
    matrices = poses.as_matrix().reshape(-1, 4, 4)
    turn, count = matrices[:, :3, :3], len(spheres)
    centre = np.einsum("tij,nj->tni", turn, spheres.centre) + matrices[:, None, :3, 3]
    limit = float(spheres.radius.max())
    near = ground.proximity(centre.reshape(-1, 3), limit)
    depth = spheres.radius - near.distance.reshape(-1, count)
    _refuse_buried(depth)
    frame, sphere = np.nonzero(depth > 0.0)
    normal = np.full_like(centre, np.nan)
    point = np.full_like(centre, np.nan)
    pressing, force = np.zeros(depth.shape), np.zeros_like(centre)
    touching = depth > 0.0
    normal[touching] = near.normal.reshape(centre.shape)[touching]
    point[touching] = near.closest.reshape(centre.shape)[touching]

    n = normal[touching]
    lowest = spheres.centre[sphere] - spheres.radius[sphere, None] * np.einsum("cij,ci->cj", turn[frame], n)
    closing = -np.einsum("ci,ci->c", n, _velocity(rate[frame], spheres.centre[sphere]))
    pressing[touching] = normal_force(
        depth[touching], closing, law.stiffness[sphere], law.exponent, law.damping[sphere], law.full_depth
    )
    velocity = _velocity(rate[frame], lowest)
    sliding = velocity - np.einsum("ci,ci->c", velocity, n)[:, None] * n
    speed = np.linalg.norm(sliding, axis=1)
    coefficient = friction_coefficient(speed, law.threshold_speed, law.static[sphere], law.kinetic[sphere])
    direction = np.divide(sliding, speed[:, None], out=np.zeros_like(sliding), where=speed[:, None] > 0.0)
    force[touching] = pressing[touching][:, None] * (n - coefficient[:, None] * direction)
    return SphereLoads(pressing, force, point, centre, normal, depth)


def _velocity(rate: Float[np.ndarray, "c 4 4"], body_point: Float[np.ndarray, "c 3"]) -> Float[np.ndarray, "c 3"]:
    return np.asarray(np.einsum("cij,cj->ci", rate[:, :3, :3], body_point) + rate[:, :3, 3])


def _refuse_buried(depth: Float[np.ndarray, "t n"]) -> None:
    buried = np.argwhere(np.isposinf(depth))
    if len(buried):
        frame, sphere = buried[0]
        raise ValueError(f"sphere {sphere + 1} is deeper under the ground than any radius in frame {frame + 1}")
