"""Where a joint is, in the frames of both segments: one point of a centre, two of an axis.

`functional_joint` finds the centre (SCoRE) or axis (SARA); here the two come as points that move with either segment.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.dynamics.functional_joint import functional_axis, functional_centre

HALF = 0.05
"""m along an axis from its middle to either point."""


@dataclass(frozen=True, eq=False)
class JointPoints:
    """Points of a joint.

    Parameters
    ----------
    first, second
        One of a centre, two of an axis, in the frames of both segments [m].
    first_sd, second_sd
        Standard errors of a centre [m], for errors without memory; None of an axis.
    rms
        Distance of what both segments say, in the ground [m], root mean square over the frames.
    looseness
        Of an axis (`FunctionalAxis`); None of a centre.
    """

    first: Float[np.ndarray, "p 3"]
    second: Float[np.ndarray, "p 3"]
    rms: float
    first_sd: Float[np.ndarray, " 3"] | None = None
    second_sd: Float[np.ndarray, " 3"] | None = None
    looseness: float | None = None

    @property
    def middle(self) -> Float[np.ndarray, " 3"]:
        """In the first segment's frame [m]."""
        return np.asarray(self.first.mean(axis=0))


def centre_points(first: RigidTransform, second: RigidTransform) -> JointPoints:
    """The centre that two segments share along their poses; ValueError as `functional_centre` has it."""
    found = functional_centre(first, second)
    return JointPoints(found.first[None], found.second[None], found.rms, found.first_sd, found.second_sd)


def axis_points(first: RigidTransform, second: RigidTransform, near: Float[np.ndarray, " 3"]) -> JointPoints:
    """Two points of the axis that two segments share, `HALF` to either side of where it is next to `near`.

    `near` is in the first segment's frame [m]. ValueError as `functional_axis` has it.
    """
    found = functional_axis(first, second)
    along = found.first_direction @ (near - found.first)
    steps = np.array([[along - HALF], [along + HALF]])
    return JointPoints(
        found.first + steps * found.first_direction,
        found.second + steps * found.second_direction,
        found.rms,
        looseness=found.looseness,
    )


def apart_in_halves(first: RigidTransform, second: RigidTransform, near: Float[np.ndarray, " 3"] | None) -> float:
    """Distance between the middles found from either half of the frames [m]; NaN where one of them moves too little.

    One half is the first and the third quarter. It holds what standard errors leave out: skin slides smoothly, and the
    same way for many frames. `near` as in `axis_points`; None of a centre.
    """
    quarter = 4 * np.arange(len(first)) // len(first)
    halves = np.flatnonzero(quarter % 2 == 0), np.flatnonzero(quarter % 2 == 1)
    parts = [(first[half], second[half]) for half in halves]
    try:
        one, other = (centre_points(*part) if near is None else axis_points(*part, near) for part in parts)
    except ValueError:
        return float("nan")
    return float(np.linalg.norm(one.middle - other.middle))
