"""Thickness between two surfaces, such as cartilage on bone or a liner: along normals, and by the nearest distance.

From the centroid of each face of OUTER the line along its normal meets INNER somewhere: the thickness along the normal.
The distance to the nearest point of INNER is never more. Both agree where the surfaces are parallel; the nearest one
comes from the side where the layer is thinner there or ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.kernels.ray import exits
from geocontact.geometry.surface import Surface

STEEP = 2.0
"""Distance along a normal over the nearest one up to which both are to the same place: surfaces 60 degrees apart."""


@dataclass(frozen=True, eq=False)
class ThicknessMap:
    """Thickness at the faces of OUTER that count.

    Parameters
    ----------
    face
        Numbers of these faces.
    point, area
        Their centroids [m] and areas [m^2].
    along, nearest
        Distance to INNER along the normal, and to its nearest point [m]; NaN where INNER is not met within `most`.
    inside
        Faces that lie inside INNER, or where that is open beyond it: the surfaces cross, there is no thickness.
    outwards
        Whether INNER is met along the normals of OUTER instead of against them.
    most
        Largest thickness [m].
    """

    face: Int[np.ndarray, " k"]
    point: Float[np.ndarray, "k 3"]
    area: Float[np.ndarray, " k"]
    along: Float[np.ndarray, " k"]
    nearest: Float[np.ndarray, " k"]
    inside: Bool[np.ndarray, " k"]
    outwards: bool
    most: float

    @property
    def covered(self) -> float:
        """Share of the area that has a thickness along the normal [-]."""
        return float(self.area[np.isfinite(self.along)].sum() / self.area.sum())

    @property
    def volume(self) -> float:
        """Integral of the thickness along the normal over OUTER [m^3]; that of the layer where it is thin."""
        there = np.isfinite(self.along)
        return float(self.along[there] @ self.area[there])

    def quantiles(self, values: Float[np.ndarray, " k"], shares: Float[np.ndarray, " q"]) -> Float[np.ndarray, " q"]:
        """Thickness below which these shares of the area lie that has one [m]; NaN where none has."""
        there = np.flatnonzero(np.isfinite(values))
        if len(there) == 0:
            return np.full(len(shares), np.nan)
        order = there[np.argsort(values[there], kind="stable")]
        middle = np.cumsum(self.area[order]) - 0.5 * self.area[order]
        return np.asarray(np.interp(shares, middle / self.area[order].sum(), values[order]))

    def mean_sd(self, values: Float[np.ndarray, " k"]) -> tuple[float, float]:
        """Mean and standard deviation over the area that has a thickness [m]; NaN where none has."""
        there = np.isfinite(values)
        if not there.any():
            return float("nan"), float("nan")
        mean = float(np.average(values[there], weights=self.area[there]))
        return mean, float(np.sqrt(np.average((values[there] - mean) ** 2, weights=self.area[there])))


def thickness_map(
    outer: Surface, inner: Surface, most: float, faces: Bool[np.ndarray, " f"] | None = None
) -> ThicknessMap:
    """Thickness of what lies between two surfaces, at the centroids of OUTER's faces.

    Lines go against the normals of OUTER, or along them where more of its area meets INNER so: open patches may be
    wound either way. Faces without area have no centroid, and one that stands in the file twice counts once.

    Beyond an open INNER lies a face whose line the other way meets it sooner, no more than `STEEP` times as far away as
    its nearest point: where surfaces cross they adjoin, and the other condyle is farther off. The whole boundary of a
    layer, a closed OUTER without `faces`, faces INNER with its underside, which is not taken for crossing.

    Parameters
    ----------
    outer, inner
        The surfaces, in one frame [m].
    most
        Farther away INNER is not met [m].
    faces
        Which faces of OUTER count; all without.
    """
    counts = (outer.face_area > 0.0) & ~outer.repeated
    face = np.flatnonzero(counts if faces is None else counts & faces)
    if len(face) == 0:
        raise ValueError(f"{outer.name}: no face counts")
    point, area = outer.vertices[outer.faces[face]].mean(axis=1), outer.face_area[face]
    normal = outer.face_normal[face]
    against, along = (_met(inner, point, way, most) for way in (-normal, normal))
    met = [float(area[np.isfinite(each)].sum()) for each in (against, along)]
    outwards = met[1] > met[0]
    near = inner.proximity(point, most).distance
    found, other = (along, against) if outwards else (against, along)
    if inner.closed:
        inside = near < 0.0
    else:
        inside = (other < found) & (other <= STEEP * np.abs(near)) & (faces is not None or not outer.closed)
    nowhere = inside | ~np.isfinite(near)
    return ThicknessMap(
        face=face,
        point=point,
        area=area,
        along=np.where(inside | ~np.isfinite(found), np.nan, found),
        nearest=np.where(nowhere, np.nan, np.abs(near)),
        inside=inside,
        outwards=outwards,
        most=most,
    )


def _met(
    inner: Surface, point: Float[np.ndarray, "k 3"], way: Float[np.ndarray, "k 3"], most: float
) -> Float[np.ndarray, " k"]:
    """Distance to where each line first meets INNER, from whichever side; infinite where it does not."""
    local, ways = np.ascontiguousarray(point - inner.centre), np.ascontiguousarray(way)
    sides = [exits(inner.tree, local, ways, float(most), side)[0] for side in (1.0, -1.0)]
    return np.asarray(np.minimum(*sides))
