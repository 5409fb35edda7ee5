"""The answer of every proximity query, whatever the shape: how far, where, and in which direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int


@dataclass(frozen=True)
class Proximity:
    """Nearest points of a shape to a set of query points, all in the shape's own frame.

    Parameters
    ----------
    distance
        Signed distance [m]: positive outside, negative inside; unsigned where `signed` is False.
        Depth of a sphere of radius r is r - distance. Infinite beyond the limit of a bounded query.
    closest
        Nearest point on the shape's boundary [m]; NaN beyond the limit.
    normal
        Outward unit normal of the boundary there, which is the gradient of the distance; NaN beyond the limit.
    face
        Face of a meshed surface the nearest point lies on, -1 for analytic shapes and beyond the limit.
    signed
        Whether the shape has an inside.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> found = gc.Sphere((0.0, 0.0, 0.0), radius=0.02).proximity(np.array([[0.05, 0.0, 0.0]]))
    >>> found.distance.round(6).tolist(), found.closest.round(6).tolist()
    ([0.03], [[0.02, 0.0, 0.0]])
    """

    distance: Float[np.ndarray, " n"]
    closest: Float[np.ndarray, "n 3"]
    normal: Float[np.ndarray, "n 3"]
    face: Int[np.ndarray, " n"]
    signed: bool = True


def within(limit: float, exact: Proximity) -> Proximity:
    """The same answer with everything farther than `limit` [m] marked as beyond it."""
    beyond = np.abs(exact.distance) > limit
    if not beyond.any():
        return exact
    return Proximity(
        np.where(beyond, np.copysign(np.inf, exact.distance), exact.distance),
        np.where(beyond[:, None], np.nan, exact.closest),
        np.where(beyond[:, None], np.nan, exact.normal),
        np.where(beyond, -1, exact.face),
        exact.signed,
    )
