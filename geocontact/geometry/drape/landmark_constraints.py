"""Marks that hold a mat while it is evened out: as a whole, not each its own corner."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array, csr_array

from geocontact.geometry.drape.geodesics import Geodesics, SurfacePoints
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.motions import motions
from geocontact.geometry.drape.positions import corners_at
from geocontact.geometry.drape.spread import Way

DEPENDENT = 1e-6  # of the largest singular value: motions that the marks do not tell apart


@dataclass(frozen=True, eq=False)
class LandmarkConstraints:
    """What is left of a mat's misses once they are seen as motions of the whole mat.

    With the misses m of all marks [m] and an orthonormal basis Q of what the motions of the mat do to its marks, Q^t m
    is nothing where no rigid move and turn along the surface brings the marks nearer to their points. The rest of m is
    what the marks contradict each other by, and pulls at nothing.

    Parameters
    ----------
    matrix
        Q^t times the shares of the nodes in the marks.
    goal
        Q^t times the places of the marks [m].
    """

    matrix: csr_array
    goal: Float[np.ndarray, " m"]

    def miss(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " m"]:
        """Of the mat with these nodes [m]."""
        return np.asarray(self.matrix @ points.ravel() - self.goal)

    def jacobian(self, axes: Float[np.ndarray, "n 2 3"]) -> csr_array:
        """Of the miss, by moves of the nodes along two axes each."""
        n = len(axes)
        node, way, x = np.meshgrid(np.arange(n), np.arange(2), np.arange(3), indexing="ij")
        along = coo_array((axes.ravel(), ((3 * node + x).ravel(), (2 * node + way).ravel())), shape=(3 * n, 2 * n))
        return csr_array(self.matrix @ along.tocsr())


def landmark_constraints(
    geodesics: Geodesics, mat: Mat, nodes: SurfacePoints, marks: Marks, owner: Int[np.ndarray, " n"], belt: Way | None
) -> LandmarkConstraints:
    """By the marks that lie on the surface with all corners of their cells; directions as the mat lies now."""
    index, share = corners_at(nodes.face.shape, marks.cells)
    there = (nodes.on.ravel()[index] | (share == 0.0)).all(axis=1)
    ways = motions(mat, nodes.point, marks.cells, belt)
    there &= np.isfinite(ways).all(axis=(0, 2))
    count = int(there.sum())
    u, size, _ = np.linalg.svd(ways[:, there].reshape(len(ways), -1).T, full_matrices=False)
    basis = u[:, size > DEPENDENT * size.max(initial=0.0)].T
    mark, corner = np.nonzero(share[there])
    row = 3 * mark[:, None] + np.arange(3)
    column = 3 * owner[index[there]][mark, corner][:, None] + np.arange(3)
    value = np.repeat(share[there][mark, corner], 3)
    shares = coo_array((value, (row.ravel(), column.ravel())), shape=(3 * count, 3 * len(owner)))
    goal = geodesics.nearest(marks.points[there]).point.ravel() if count else np.zeros(0)
    return LandmarkConstraints(csr_array(csr_array(basis) @ shares.tocsr()), basis @ goal)
