"""Centre of pressure of a foot: on spheres, from a plate, and along the foot from its heel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.wrench import Wrench
from geocontact.loads.resultant import resultant, weighted_centre
from geocontact.loads.sphere_set import SphereLoads, SphereSet


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
    """The heel is the rearmost point of any sphere; the length [m] is the way to the foremost by default."""
    along = direction / np.linalg.norm(direction)
    place = spheres.centre @ along
    heel = float((place - spheres.radius).min())
    return FootAxis(along, heel, float((place + spheres.radius).max()) - heel if length is None else length)


def centre_in_foot(
    centre: Float[np.ndarray, " t"],
    x: Float[np.ndarray, " t"],
    y: Float[np.ndarray, " t"],
    pitch: Float[np.ndarray, " t"],
) -> Float[np.ndarray, " t"]:
    """Place along the foot's x axis of a point of the ground [m].

    The foot's frame lies at (x, y) in the ground's frame and is turned by pitch, positive where the toe is up; a point
    (centre, 0) of level ground has (centre - x) cos(pitch) - y sin(pitch) there. It is what the foot on spheres
    predicts as px - radius sin(pitch) of a sphere that touches the ground (`systems.foot_spheres`).

    Parameters
    ----------
    centre
        Centre of pressure in the ground's frame [m]; NaN where there is none, and so is what comes out.
    x, y
        Origin of the foot's frame [m], y above the ground.
    pitch
        [rad].
    """
    return np.asarray((centre - x) * np.cos(pitch) - y * np.sin(pitch))


def points_in_foot(points: Float[np.ndarray, "t 3"], poses: RigidTransform) -> Float[np.ndarray, "t 3"]:
    """Points of the ground's frame [m] in the foot's; NaN stays NaN.

    `poses` are those of the foot in the ground's frame, one per point.
    """
    matrices = poses.inv().as_matrix().reshape(-1, 4, 4)
    return np.asarray(np.einsum("tij,tj->ti", matrices[:, :3, :3], points) + matrices[:, :3, 3])


def path_length(centre: Float[np.ndarray, "t 3"]) -> float:
    """Length of the path of a centre [m], without the ways across frames that have none (NaN)."""
    return float(np.nansum(np.linalg.norm(np.diff(centre, axis=0), axis=1)))


GROUND_POINT = "ground"
SPHERE_CENTRE = "sphere"
POINTS = (GROUND_POINT, SPHERE_CENTRE)
"""What is weighted with the normal forces: the points on the ground, or the centres of the spheres."""
Smooth = Callable[[Float[np.ndarray, "t k"]], Float[np.ndarray, "t k"]]
"""Columns over time, each filtered."""


@dataclass(frozen=True)
class CentreOfPressure:
    """Load of the ground on the foot over a motion.

    Parameters
    ----------
    centre
        Centre of pressure [m]; NaN where the normal force is below the gate.
    pressing
        Sum of the normal forces [N].
    normal
        Direction of the sum of the normal forces as vectors, the ground's normal on a plane; NaN below the gate.
    free_moment
        Moment of all forces about `normal` through `centre` [N m]; NaN below the gate.
    wrench
        All forces together, about the origin of the frame.
    """

    centre: Float[np.ndarray, "t 3"]
    pressing: Float[np.ndarray, " t"]
    normal: Float[np.ndarray, "t 3"]
    free_moment: Float[np.ndarray, " t"]
    wrench: Wrench


def centre_of_pressure(
    loads: SphereLoads, point: str = GROUND_POINT, gate: float = 0.0, smooth: Smooth | None = None
) -> CentreOfPressure:
    """Centre of the normal forces, sum of F_n x over sum of F_n.

    On one plane the ground-point centre is what a force plate in that plane shows. On uneven ground no single point
    does that; this remains the centre of the normal forces.

    Parameters
    ----------
    point
        "ground": x is the point on the ground. "sphere": x is the sphere's centre, as in the study of the
        variable-stiffness foot. On level ground the two differ along the normal; on a slope or step also beside it.
    gate
        Normal force [N] below which there is no centre.
    smooth
        A linear filter over time of forces and moments, as plates are filtered: the centre is that of what it leaves.
    """
    if point not in POINTS:
        raise ValueError(f"point must be {' or '.join(POINTS)}, not {point!r}")
    x = loads.point if point == GROUND_POINT else loads.centre
    pressing, wrench = loads.pressing.sum(axis=1), resultant(loads.force, loads.point, "ground")
    push = np.einsum("tn,tni->ti", loads.pressing, np.nan_to_num(loads.normal))
    touching, own = pressing > 0.0, np.zeros((len(pressing), 3))
    own[touching] = weighted_centre(x[touching], loads.pressing[touching], "centre of pressure")
    if smooth is not None:
        first, moment, push = smooth(pressing[:, None]), smooth(pressing[:, None] * own), smooth(push)
        wrench = replace(wrench, force=smooth(wrench.force), moment=smooth(wrench.moment))
        pressing, own = first[:, 0], np.divide(moment, first, out=np.zeros_like(own), where=first > 0.0)
    loaded = (pressing >= gate) & (pressing > 0.0)
    centre, normal, free = (np.full(shape, np.nan) for shape in ((len(loaded), 3), (len(loaded), 3), len(loaded)))
    centre[loaded] = own[loaded]
    normal[loaded] = push[loaded] / np.linalg.norm(push[loaded], axis=1, keepdims=True)
    free[loaded] = np.einsum("ti,ti->t", wrench.moved_to(centre).moment[loaded], normal[loaded])
    return CentreOfPressure(centre, pressing, normal, free, wrench)
