"""Centre of pressure of a foot: on spheres, from a plate, and along the foot from its heel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.frame_blocks import blocks, release, worked, worked_together
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
    found = 0.0
    for some in blocks(len(centre), 3):
        steps = np.diff(centre[some.start : some.stop + 1], axis=0)
        found += float(np.nansum(np.linalg.norm(steps, axis=1)))
        release()
    return found


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
    pressing, force, moment, push, own = worked_together(
        _sums, loads.pressing, loads.force, loads.point, loads.normal, x
    )
    if smooth is not None:
        first = smooth(pressing[:, None])
        own = worked(_over, smooth(worked(_times, pressing, own)), first)
        pressing, force, moment, push = first[:, 0], smooth(force), smooth(moment), smooth(push)

    def at_centre(
        pressing: Float[np.ndarray, " t"],
        own: Float[np.ndarray, "t 3"],
        push: Float[np.ndarray, "t 3"],
        force: Float[np.ndarray, "t 3"],
        moment: Float[np.ndarray, "t 3"],
    ) -> tuple[np.ndarray, ...]:
        loaded = (pressing >= gate) & (pressing > 0.0)
        centre, normal, free = (np.full(shape, np.nan) for shape in (own.shape, own.shape, len(own)))
        centre[loaded] = own[loaded]
        normal[loaded] = push[loaded] / np.linalg.norm(push[loaded], axis=1, keepdims=True)
        turning = _about_origin(force, moment).moved_to(centre).moment
        free[loaded] = np.einsum("ti,ti->t", turning[loaded], normal[loaded])
        return centre, normal, free

    centre, normal, free = worked_together(at_centre, pressing, own, push, force, moment)
    return CentreOfPressure(centre, pressing, normal, free, _about_origin(force, moment))


def _about_origin(force: Float[np.ndarray, "t 3"], moment: Float[np.ndarray, "t 3"]) -> Wrench:
    return Wrench(force, moment, np.broadcast_to(np.zeros(3), force.shape), "ground")


def _sums(
    pressing: Float[np.ndarray, "t n"],
    force: Float[np.ndarray, "t n 3"],
    point: Float[np.ndarray, "t n 3"],
    normal: Float[np.ndarray, "t n 3"],
    x: Float[np.ndarray, "t n 3"],
) -> tuple[np.ndarray, ...]:
    """Normal force, force, moment about the origin, normal forces as vectors, and their centre (0 without any)."""
    total, wrench = pressing.sum(axis=1), resultant(force, point, "ground")
    push = np.einsum("tn,tni->ti", pressing, np.nan_to_num(normal))
    touching, own = total > 0.0, np.zeros((len(total), 3))
    own[touching] = weighted_centre(x[touching], pressing[touching], "centre of pressure")
    return total, wrench.force, wrench.moment, push, own


def _times(pressing: Float[np.ndarray, " t"], own: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3"]:
    return np.asarray(pressing[:, None] * own)


def _over(moment: Float[np.ndarray, "t 3"], pressing: Float[np.ndarray, "t 1"]) -> Float[np.ndarray, "t 3"]:
    """The centre that a moment of normal forces belongs to; 0 where none presses."""
    return np.asarray(np.divide(moment, pressing, out=np.zeros_like(moment), where=pressing > 0.0))
