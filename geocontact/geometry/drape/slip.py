"""How far a mat may lie elsewhere on the surface, estimated from how far its own marks miss."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Way, corners_at, directions
from geocontact.geometry.register.quality import PoseCovariance


def motions(
    mat: Mat, points: Float[np.ndarray, "r1 c1 3"], cells: Float[np.ndarray, "k 2"], belt: Way | None = None
) -> Float[np.ndarray, "m k 3"]:
    """Velocities along the surface at positions counted in cells, one row per motion; NaN off the surface.

    Along rows and along columns by 1 m/m, and turned about the mat's middle by 1 rad in the plane that it has when it
    is flat: a = (a1, a2) away from the middle goes (-a2, a1). A belt of length L meets itself and cannot turn so; as a
    ring of radius L / 2 pi it is tilted instead, about two axes: across it by L / 2 pi times cosine and sine of the
    angle 2 pi a / L that it has gone around.
    """
    row, column = directions(points, cells).transpose(1, 0, 2)
    ahead, aside = mat.away(cells).T
    if belt is None:
        return np.stack([row, column, ahead[:, None] * column - aside[:, None] * row])
    length = mat.rows * mat.pitch[0] if belt == "rows" else mat.columns * mat.pitch[1]
    across, gone = (column, ahead) if belt == "rows" else (row, aside)
    radius, angle = length / (2.0 * np.pi), 2.0 * np.pi * gone[:, None] / length
    return np.stack([row, column, radius * np.cos(angle) * across, radius * np.sin(angle) * across])


TOLD = 1e-6  # of the firmest motion: what marks tell less of is not identified


def slip_covariance(mat: Mat, laid: Drape, marks: Marks, belt: Way | None = None) -> PoseCovariance | None:
    """Covariance of the small motion by which the mat lies elsewhere; None where the marks leave nothing over.

    The marks fix the motions of the mat over the surface (`motions`) by least squares. With errors of variance s^2
    along the surface in both directions of each of k marks, A what m motions do to the marks, their covariance is
    s^2 (A^t A)^-1: for the flat mat s^2/k of either shift of the marks' middle and s^2 / sum |a|^2 of the turn, a the
    arms of the marks (the rigid fit in the plane; Sibson 1979). s^2 is the sum of the squared misses along the surface
    over 2 k - m; across the surface a mat cannot lie elsewhere. Two marks leave 1 degree of freedom, those of a belt 0.

    A mat that is shifted along a curved surface is turned in space too. Its motion there is the rigid one that is
    nearest to the velocities of its cells: exact on planes, cylinders and spheres.
    """
    index, share = corners_at(laid.nodes.shape, marks.cells)
    corners = np.where(share[..., None] > 0.0, share[..., None] * laid.nodes.reshape(-1, 3)[index], 0.0)
    ways = motions(mat, laid.nodes, marks.cells, belt)
    there = np.isfinite(corners).all(axis=(1, 2)) & np.isfinite(ways).all(axis=(0, 2))
    jacobian = ways[:, there].reshape(len(ways), -1).T
    freedom = 2.0 * int(there.sum()) - len(ways)
    if (
        freedom <= 0.0
        or not laid.covered.any()
        or np.linalg.matrix_rank(jacobian, TOLD * np.linalg.norm(jacobian, 2)) < len(ways)
    ):
        return None
    miss = (marks.points - corners.sum(axis=1))[there]
    up = np.cross(*directions(laid.nodes, marks.cells)[there].transpose(1, 0, 2))
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    miss -= np.einsum("ki,ki->k", miss, up)[:, None] * up
    own = float((miss**2).sum()) / freedom * np.linalg.inv(jacobian.T @ jacobian)
    about, carried = _in_space(mat, laid, belt)
    return PoseCovariance(about, carried @ own @ carried.T, freedom)


def _in_space(mat: Mat, laid: Drape, belt: Way | None) -> tuple[Float[np.ndarray, " 3"], Float[np.ndarray, "6 m"]]:
    """Middle of the cells [m], and the shift of it and the turn that come nearest to each motion."""
    row, column = np.meshgrid(np.arange(mat.rows) + 0.5, np.arange(mat.columns) + 0.5, indexing="ij")
    ways = motions(mat, laid.nodes, np.column_stack([row.ravel(), column.ravel()]), belt)
    there = np.isfinite(ways).all(axis=(0, 2)) & laid.covered.ravel()
    ways, points = ways[:, there], laid.centre.reshape(-1, 3)[there]
    about = points.mean(axis=0)
    arms = points - about
    inertia = np.eye(3) * float((arms**2).sum()) - arms.T @ arms
    turn = np.linalg.pinv(inertia, rcond=1e-9) @ np.cross(arms, ways).sum(axis=1).T
    return about, np.concatenate([ways.mean(axis=1).T, turn])
