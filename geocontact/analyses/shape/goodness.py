"""Whether a cylinder, sphere or plane describes the points that it was fitted to.

No noise of a surface is stated: a shape is compared with what is simpler, a curved one with the flat one, a flat one
with the spread of the points along it, and a sphere with the sphere through the inner half of its own points.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from jaxtyping import Float

from geocontact.data.plausible import ROUNDED
from geocontact.geometry.fit.found import OUTLYING, ShapeFit
from geocontact.geometry.fit.patch import Patch, looks
from geocontact.geometry.fit.solver import FINEST
from geocontact.geometry.fit.sphere import fit_sphere
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit, of_size

POOR, NONE = 0.1, 0.3
"""Shares of the radius: root mean square of the points from which on it is doubtful; of inliers it contradicts."""
MEANS = 0.1
"""Least share of the squared distances from the best plane that a curved shape explains."""
THICK, ROUND = 0.3, 0.8
"""Distance of the points from a plane beside their spread along it, root mean squares: doubtful; no plane at all."""
FEW = 0.7
"""Share of inliers below which the patch may be another one."""
INNER, EDGE, BEYOND = 0.5, 0.08, 1.5
"""Share of a sphere's points, the nearest to the middle of the patch, whose radius is compared with that of all; and
the share of it by which the two then differ, and times their 95 % intervals. Ellipsoids with axes that differ by 10 %
reach 0.065, caps of 30 to 80 degrees with a rim of a sixth of the radius 0.14 to 0.44."""

OPPOSITE, OTHER_SIDE = -0.5, 0.05
"""Cosine between a face's normal and that of the shape, below which it looks the other way; and the share of the area
of what lies on the shape that does."""


def both_sides(name: str, fit: ShapeFit, patch: Patch) -> Iterable[Doubt]:
    """Faces of a curved shape that look towards its centre among others that look away from it, as of a shell."""
    if fit.radius is None:
        return
    surface, faces = patch.surface, patch.faces
    corners = surface.vertices[surface.faces[faces]]
    off = np.abs(fit.distance(corners.reshape(-1, 3))).reshape(-1, 3).mean(axis=1)
    on_it = off <= max(OUTLYING * fit.quality.noise, FINEST)
    area, cosine = surface.face_area[faces] * on_it, looks(patch, fit)
    if not area.any():
        return
    away, towards = (float(area[which].sum() / area.sum()) for which in (cosine > -OPPOSITE, cosine < OPPOSITE))
    if min(away, towards) > OTHER_SIDE:
        said = f"{name}: {away:.0%} of the area look away from the {'centre' if fit.axis is None else 'axis'} and"
        remedy = "are inside and outside, or a rim, among the faces? choose one side with `region`"
        yield Doubt(f"{said} {towards:.0%} towards it: {remedy}", False, min(away, towards))


def goodness_of_shape(
    name: str, fit: ShapeFit, points: Float[np.ndarray, "n 3"], also: Iterable[Doubt]
) -> GoodnessOfFit:
    """The points beside the shape; `name` is that of the patch, `also` are the doubts of `unsaid`."""
    doubts = [*also]
    if fit.radius is not None:
        doubts += _of_curved(name, fit, fit.radius, points)
    share = float(fit.quality.inlier.mean())
    if fit.exact_in_part or share < FEW:
        said = f"{name}: {1.0 - share:.0%} of the points are off the {fit.shape}"
        doubts.append(Doubt(said, share < MUCH and not fit.exact_in_part, 1.0 - share))
    if not fit.quality.converged:
        doubts.append(Doubt(f"{name}: the search did not converge", False))
    return GoodnessOfFit(tuple(doubts), (name,))


def unsaid(name: str, fit: ShapeFit, points: Float[np.ndarray, "n 3"]) -> Iterable[Doubt]:
    """What no other warning says: points thick beside a plane, a radius that they do not determine, its size."""
    if fit.radius is None:
        yield from _of_plane(name, fit, points)
    elif fit.radius_interval is not None and fit.radius_interval[0] <= 0.0:
        yield Doubt(f"{name}: the interval of the radius reaches zero and below", False)
    else:
        yield from of_size(f"{name}: radius", _interval(fit), ROUNDED)
    if fit.shape == "sphere":
        yield from _of_edge(name, fit, points)


def _interval(fit: ShapeFit) -> tuple[float, float]:
    """95 % interval of the radius, else the radius twice [m]."""
    return fit.radius_interval or (fit.radius or 0.0, fit.radius or 0.0)


def _of_edge(name: str, sphere: ShapeFit, points: Float[np.ndarray, "n 3"]) -> Iterable[Doubt]:
    """The radius of all points against that of the inner half, without whatever surrounds it.

    Curvatures are compared: their error, the interval's half over the radius squared, is as symmetric for a shallow cap
    as that of its depth. An inner half that a plane describes as well has no radius.
    """
    offset = points - sphere.point
    way = offset / np.linalg.norm(offset, axis=1)[:, None]
    nearness = way @ way.mean(axis=0)
    inside = points[nearness >= np.quantile(nearness, 1.0 - INNER)]
    try:
        inner = fit_sphere(np.ascontiguousarray(inside))
    except ValueError:  # too few points, or all in one plane
        return
    radius, own = sphere.radius or np.inf, inner.radius or np.inf
    known = sum(0.5 * float(np.diff(_interval(each))[0]) / (each.radius or np.inf) ** 2 for each in (sphere, inner))
    if abs(own - radius) <= EDGE * radius or abs(1.0 / own - 1.0 / radius) <= BEYOND * known:
        return
    if any(_of_curved(name, inner, own, inside)):
        return
    said = f"{name}: radius {1e3 * radius:.2f} mm, and {1e3 * own:.2f} mm by the inner half of the points"
    remedy = "is a rim, lip or neck among the faces? choose those of the sphere with `region`"
    yield Doubt(f"{said}: {remedy}", False, abs(own / radius - 1.0))


def _of_curved(name: str, fit: ShapeFit, radius: float, points: Float[np.ndarray, "n 3"]) -> Iterable[Doubt]:
    if fit.rms > POOR * radius:
        said = f"{name}: rms {1e3 * fit.rms:.2f} mm is {fit.rms / radius:.0%} of the radius"
        yield Doubt(said, fit.rms_inliers > NONE * radius, fit.rms / radius)
    explained = 1.0 - (fit.rms_inliers / max(_spreads(points[fit.quality.inlier])[0], 1e-300)) ** 2
    if explained < MEANS:
        yield Doubt(f"{name}: a plane is as near to the points as this {fit.shape}", True, 1.0 - explained)


def _of_plane(name: str, fit: ShapeFit, points: Float[np.ndarray, "n 3"]) -> Iterable[Doubt]:
    along = float(_spreads(points[fit.quality.inlier])[1])
    if fit.rms > THICK * along:
        said = f"{name}: rms {1e3 * fit.rms:.2f} mm from the plane beside {1e3 * along:.2f} mm along it"
        yield Doubt(said, fit.rms_inliers > ROUND * along, fit.rms / along)


def _spreads(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " 3"]:
    """Root mean squares of the points about their middle along their principal axes, the least first [m]."""
    return np.asarray(np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[::-1] / np.sqrt(len(points)))
