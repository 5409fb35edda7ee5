"""A belt around a body: whether its ends meet, and what brings them together."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.drape.mat import Mat
from geocontact.geometry.drape.spread import Geodesics, SurfacePoints, Way

AROUND = 0.1  # a belt may be this much longer or shorter than the way around the body
ALONG = 0.7  # of the gap between the ends that is along the belt: they face each other, or passed each other


class NotAroundError(ValueError):
    """A belt that does not close on itself where it was put."""


def closed(geodesics: Geodesics, mat: Mat, nodes: SurfacePoints, belt: Way) -> SurfacePoints:
    """Corners of a spread belt shifted along it, each in proportion to its way from the middle, until the ends meet.

    Every ring takes up its own difference between the length of the belt and the way around, so that the belt is where
    it was put and its cells share the difference.
    """
    along = 0 if belt == "rows" else 1
    point = np.moveaxis(nodes.point, along, 0)
    face = np.moveaxis(nodes.face, along, 0)
    if not (np.isfinite(point[0]).all() and np.isfinite(point[-1]).all()):
        raise NotAroundError(f"the belt runs off {geodesics.surface.name}, which does not go all the way around")
    start, end = (
        way / np.linalg.norm(way, axis=1, keepdims=True) for way in (point[1] - point[0], point[-1] - point[-2])
    )
    gap = point[-1] - point[0]
    past = 0.5 * np.einsum("ij,ij->i", gap, start + end)  # of the last corner over the first, on each ring
    _goes_around(geodesics, mat, belt, float(np.linalg.norm(gap, axis=1).mean()), float(past.mean()))
    ahead = np.empty_like(point)
    ahead[1:-1], ahead[0], ahead[-1] = point[2:] - point[:-2], start, end
    ahead /= np.maximum(np.linalg.norm(ahead, axis=2, keepdims=True), 1e-300)
    share = np.linspace(0.5, -0.5, len(point))[:, None]
    shift = np.nan_to_num((share * past)[..., None] * ahead)
    moved = geodesics.moved(SurfacePoints(face.ravel(), point.reshape(-1, 3)), shift.reshape(-1, 3))
    on = moved.on
    face = np.where(on, moved.face, face.ravel()).reshape(face.shape)
    point = np.where(on[:, None], moved.point, point.reshape(-1, 3)).reshape(point.shape)
    return SurfacePoints(
        np.ascontiguousarray(np.moveaxis(face, 0, along)), np.ascontiguousarray(np.moveaxis(point, 0, along))
    )


def _goes_around(geodesics: Geodesics, mat: Mat, belt: Way, gap: float, past: float) -> None:
    """Refuse a belt whose ends are far apart, or far past each other, on the body."""
    length = (mat.rows if belt == "rows" else mat.columns) * mat.pitch[0 if belt == "rows" else 1]
    if gap <= AROUND * length:
        return
    word = f": about {gap:.3f} m too {'long' if past > 0.0 else 'short'}" if abs(past) > ALONG * gap else ""
    raise NotAroundError(
        f"the belt is {length:.3f} m long and its ends lie {gap:.3f} m apart on {geodesics.surface.name}{word}; it "
        "does not go once around there"
    )
