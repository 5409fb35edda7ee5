"""Centre of pressure of a foot on spheres: one point, one force, one free moment per frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.data.wrench import Wrench
from geocontact.loads.resultant import resultant
from geocontact.loads.sphere_loads import SphereLoads
from geocontact.loads.weighted_centre import weighted_centre

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
