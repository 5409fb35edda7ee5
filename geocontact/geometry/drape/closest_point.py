"""The plain way beside the drape: a flat mat, every corner put straight onto the nearest point of the surface."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.drape.cells import Drape, measured
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Geodesics, SurfacePoints, between
from geocontact.geometry.register.landmarks import fit_landmarks
from geocontact.geometry.surface import on_boundary

ASIDE = 1e-6  # of the pitch; a corner so far beside the rim is not above the surface


def project(geodesics: Geodesics, mat: Mat, at: Marks | RigidTransform) -> Drape:
    """The flat mat projected onto the surface by nearest points.

    It takes no care of the pitch: a mat that touches a tube of radius R along a line keeps of a cell between the
    distances y1 and y2 from that line only R (atan(y2 / R) - atan(y1 / R)), less with every column down the side.
    Corners beyond the rim of an open surface are not covered.

    Parameters
    ----------
    at
        Three marks or more, to which the flat mat is fitted; or its pose: rows along x, columns along y (against it
        where the mat is mirrored), z away from the body, the origin in its middle.
    """
    flat = mat.flat()
    if isinstance(at, Marks):
        at.on(mat)
        ahead, aside = mat.away(at.cells).T
        marks = np.column_stack([ahead, mat.hand * aside, np.zeros(len(ahead))])
        names = tuple(at.name(k) for k in range(len(marks)))
        pose = fit_landmarks(marks, at.points, names=names).pose
    else:
        pose = at
    points = pose.apply(flat.reshape(-1, 3))
    places = geodesics.nearest(points)
    normal = geodesics.normal(places)
    off = points - places.point
    beside = np.linalg.norm(off - np.einsum("ij,ij->i", off, normal)[:, None] * normal, axis=1)
    lost = (beside > ASIDE * min(mat.pitch)) & on_boundary(geodesics.surface, places.point, places.face)
    face = np.where(lost, -1, places.face).reshape(flat.shape[:2])
    point = np.where(lost[:, None], np.nan, places.point).reshape(flat.shape)
    nodes = SurfacePoints(face, point)
    misses = np.linalg.norm(between(nodes, at.cells) - at.points, axis=1) if isinstance(at, Marks) else None
    return measured(geodesics, mat, nodes, misses)
