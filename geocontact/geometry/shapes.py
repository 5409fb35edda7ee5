"""Half-space, sphere and tube: shapes whose distance is a formula, and the answer of every proximity query."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.sagittal import off_axis


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


Vector = tuple[float, float, float]


def _unit(vector: Vector) -> Float[np.ndarray, " 3"]:
    v = np.asarray(vector, float)
    length = float(np.linalg.norm(v))
    if not np.isfinite(length) or length == 0.0:
        raise ValueError(f"direction {vector} has no length")
    return v / length


def _directions(offset: Float[np.ndarray, "n 3"], spare: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "n 3"]:
    """Unit vectors along `offset`; `spare` where it vanishes and every direction is as good."""
    length = np.linalg.norm(offset, axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(length > 0.0, offset / length, spare)


def _answer(
    distance: Float[np.ndarray, " n"],
    points: Float[np.ndarray, "n 3"],
    normal: Float[np.ndarray, "n 3"],
    limit: float,
) -> Proximity:
    face = np.full(len(points), -1, np.int64)
    return within(limit, Proximity(distance, points - distance[:, None] * normal, normal, face))


@dataclass(frozen=True)
class HalfSpace:
    """Everything below a plane: the ground, a flat plate.

    Parameters
    ----------
    point
        Any point on the plane [m].
    normal
        Outward direction, of any length.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> gc.HalfSpace().proximity(np.array([[0.0, -0.002, 0.0]])).distance.round(6).tolist()
    [-0.002]
    """

    point: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 1.0, 0.0)

    def proximity(self, points: Float[np.ndarray, "n 3"], limit: float = np.inf) -> Proximity:
        """Signed height above the plane; closest point is the foot of the perpendicular."""
        n = _unit(self.normal)
        distance = (points - np.asarray(self.point)) @ n
        return _answer(distance, points, np.broadcast_to(n, points.shape).copy(), limit)


@dataclass(frozen=True)
class Sphere:
    """Solid ball: heel and toe spheres, femoral heads. centre and radius in m.

    >>> import geocontact as gc, numpy as np
    >>> gc.Sphere((0.0, 0.0, 0.0), radius=0.02).proximity(np.array([[0.01, 0.0, 0.0]])).distance.round(6).tolist()
    [-0.01]
    """

    centre: Vector
    radius: float

    def proximity(self, points: Float[np.ndarray, "n 3"], limit: float = np.inf) -> Proximity:
        """|x - centre| - radius; at the very centre the normal is taken along x."""
        offset = points - np.asarray(self.centre)
        normal = _directions(offset, np.array([1.0, 0.0, 0.0]))
        distance = np.linalg.norm(offset, axis=1) - self.radius
        return _answer(distance, points, normal, limit)


@dataclass(frozen=True)
class Tube:
    """Hollow round tube of infinite length; the *material* is outside the bore: a point on the axis is `radius` away.

    Sphere-in-tube contact: a sphere of radius r touches when its centre is closer than r to the wall. Distance is
    positive in the bore and negative in the wall; the normal points to the axis.

    Parameters
    ----------
    point, direction
        Axis: any point on it [m], direction of any length.
    radius
        Radius of the bore [m].

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> bore = gc.Tube((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), radius=0.03)
    >>> bore.proximity(np.array([[0.01, 0.0, 0.0]])).distance.round(6).tolist()
    [0.02]
    """

    point: Vector
    direction: Vector
    radius: float

    def proximity(self, points: Float[np.ndarray, "n 3"], limit: float = np.inf) -> Proximity:
        """radius - distance from the axis; on the axis itself any radial direction is as good, one is taken."""
        axis = _unit(self.direction)
        offset = points - np.asarray(self.point)
        radial = np.column_stack(off_axis((offset[:, 0], offset[:, 1], offset[:, 2]), tuple(axis))[1])
        spare = np.eye(3)[int(np.argmin(np.abs(axis)))]
        spare = spare - (spare @ axis) * axis
        outward = _directions(radial, spare / np.linalg.norm(spare))
        distance = self.radius - np.linalg.norm(radial, axis=1)
        return _answer(distance, points, -outward, limit)
