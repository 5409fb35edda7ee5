"""A mat spread along straightest lines: a spine through its middle, and ribs that leave it at right angles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.geometry.drape.geodesics import Geodesics, SurfacePoints
from geocontact.geometry.drape.mat import Mat

Way = Literal["rows", "columns"]


@dataclass(frozen=True, eq=False)
class Anchor:
    """Where the middle of the mat lies and which way its rows run from there.

    Parameters
    ----------
    place
        One place on the surface.
    heading
        Unit direction of increasing row there, in the plane of the place's face.
    """

    place: SurfacePoints
    heading: Float[np.ndarray, " 3"]

    @classmethod
    def at(cls, geodesics: Geodesics, point: Float[np.ndarray, " 3"], heading: Float[np.ndarray, " 3"]) -> Anchor:
        """At the place nearest to a point [m], with a heading near the one given (need not be a unit vector)."""
        place = geodesics.nearest(point[None])
        normal = geodesics.normal(place)[0]
        ahead = heading - (heading @ normal) * normal
        if not np.linalg.norm(ahead) > 1e-6 * np.linalg.norm(heading):
            raise ValueError("the rows of the mat stand upright on the surface; their direction must run along it")
        return cls(place, ahead / np.linalg.norm(ahead))

    def turned(self, geodesics: Geodesics, angle: float) -> Anchor:
        """The heading turned by an angle [rad], counter-clockwise seen from outside."""
        side = np.cross(geodesics.normal(self.place)[0], self.heading)
        return Anchor(self.place, np.cos(angle) * self.heading + np.sin(angle) * side)

    def carried(self, geodesics: Geodesics, ahead: float, aside: float) -> Anchor:
        """Moved [m] along its heading and to the left of it, in one straight line; the heading keeps its angle to it.

        Off the surface the place says so.
        """
        far = float(np.hypot(ahead, aside))
        if far == 0.0:
            return self
        way = self.turned(geodesics, float(np.arctan2(aside, ahead)))
        places, headings = geodesics.along(self.place, way.heading[None], np.array([far]))
        there = SurfacePoints(places.face[0], places.point[0])
        if not there.on[0]:
            return Anchor(there, headings[0, 0])
        return Anchor(there, headings[0, 0]).turned(geodesics, -float(np.arctan2(aside, ahead)))


def spread(
    geodesics: Geodesics,
    anchor: Anchor,
    mat: Mat,
    ahead: Float[np.ndarray, " a"],
    aside: Float[np.ndarray, " b"],
    spine: Way = "rows",
) -> SurfacePoints:
    """Places of all mat positions (ahead, aside) [m] from the anchor, along rows and along columns; shape (a, b).

    The spine runs along the rows (or columns) through the anchor; from each of its stations a rib leaves at a right
    angle (geodesic parallel, or Fermi, coordinates; do Carmo, Differential Geometry of Curves and Surfaces, sec. 4.6).
    Lengths along the spine and along every rib are kept, and all of them where the surface can be laid flat. Elsewhere
    neighbouring ribs at distance v from the spine are apart by the factor cos(v sqrt(K)), K the Gaussian curvature.
    """
    columns = mat.hand * np.cross(geodesics.normal(anchor.place)[0], anchor.heading)
    if spine == "rows":
        nodes, heading = geodesics.along(anchor.place, anchor.heading[None], ahead)
        ribs, sense = aside, mat.hand
    else:
        nodes, heading = geodesics.along(anchor.place, columns[None], aside)
        ribs, sense = ahead, -mat.hand
    base = SurfacePoints(nodes.face[0], nodes.point[0])
    out = sense * np.cross(geodesics.normal(base), heading[0])
    places, _ = geodesics.along(base, out, ribs)
    if spine == "rows":
        return places
    return SurfacePoints(np.ascontiguousarray(places.face.T), np.ascontiguousarray(places.point.transpose(1, 0, 2)))
