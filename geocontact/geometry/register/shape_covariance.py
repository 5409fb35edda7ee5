"""How far a pose found by shape may be off: noise of the scan's vertices carried through the fit."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.sparse import coo_array
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.register.icp import BIWEIGHT, FINEST, NORMAL, IcpSearch, Partners, partners_on, system
from geocontact.geometry.register.samples import sampled
from geocontact.geometry.register.uncertainty import PoseCovariance
from geocontact.geometry.surface import Surface

SLIDES = 1e-4  # of the firmest motion, as a root: what changes distances by less is left as the start gave it


def shape_covariance(
    moving: Surface,
    fixed: Surface,
    pose: RigidTransform,
    search: IcpSearch | None = None,
    start: PoseCovariance | None = None,
) -> PoseCovariance:
    """Covariance of the pose X_BA that `icp` found.

    The fit solves sum psi(h) J = 0 with Tukey's psi of the heights h, so its error is to first order the M-estimator's
    (Huber 1981, sec. 7.6) E[psi^2]/E[psi']^2 H^-1 (G^t G) H^-1 with H = J^t J. Points on one face share the noise of
    its corners: b are the shares of the corners, of length 1, and G = b^t J sums over every vertex what leans on it, so
    that more points than vertices do not pretend to know more. What the shapes leave open is taken from `start`.

    The noise is taken as independent from vertex to vertex, and as the scan's alone: a scan that is bent, or that was
    smoothed, is further off than this says.
    """
    search = search or IcpSearch()
    face, corner = sampled(moving, search.points)
    points = np.einsum("nk,nki->ni", corner, moving.vertices[moving.faces[face]])
    partners = partners_on(fixed, pose.apply(points), pose.rotation.apply(moving.face_normal[face]), search)
    rows, weight, middle, spread = system(partners)
    used = weight > 0.0
    rows, number = rows[used], partners.number[used]
    psi, slope = _tukey(partners, used)
    faces = moving.topology.merged[moving.faces[face[number]]]
    shared = _shared(rows, corner[number], faces)
    values, axes = np.linalg.eigh(rows.T @ rows)
    firm = values > SLIDES**2 * values[-1]
    inverse = (axes[:, firm] / values[firm]) @ axes[:, firm].T
    counted = min(len(number), len(np.unique(faces)))
    freedom = max(float(counted - 6), 1.0)
    size = float(np.mean(psi**2)) / float(np.mean(slope)) ** 2 * counted / freedom
    matrix = size * inverse @ shared @ inverse
    scale = np.repeat([1.0, 1.0 / spread], 3)
    if start is not None and not firm.all():
        free = axes[:, ~firm] @ axes[:, ~firm].T
        matrix += free @ (start.at(middle) / np.outer(scale, scale)) @ free
    return PoseCovariance(middle, matrix * np.outer(scale, scale), freedom)


def _tukey(partners: Partners, used: np.ndarray) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """psi(h) [m] and its slope."""
    scale = BIWEIGHT * max(NORMAL * float(np.median(np.abs(partners.height))), FINEST)
    share = (partners.height[used] / scale) ** 2
    return partners.height[used] * (1.0 - share) ** 2, (1.0 - share) * (1.0 - 5.0 * share)


def _shared(
    rows: Float[np.ndarray, "n 6"], corner: Float[np.ndarray, "n 3"], faces: np.ndarray
) -> Float[np.ndarray, "6 6"]:
    """G^t G."""
    unit = corner / np.linalg.norm(corner, axis=1, keepdims=True)
    at = np.repeat(np.arange(len(rows)), 3)
    leaning = coo_array((unit.ravel(), (at, faces.ravel())), shape=(len(rows), int(faces.max()) + 1)).tocsr()
    summed = leaning.T @ rows
    return np.asarray(summed.T @ summed)
