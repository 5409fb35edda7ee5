"""How alike two surfaces are curved where they face each other: relative principal curvatures and index of congruence.

Two surfaces that touch, or nearly, are to second order h = (κ_min u² + κ_max v²)/2 apart, with the principal curvatures
of the one relative to the other. Both bodies' curvature tensors, convex positive, add up (Johnson 1985, Contact
Mechanics, sec. 4.1); the eigenvalues of the sum in the tangent plane are what Ateshian, Rosenwasser and Mow (1992,
J Biomech 25(6), 591) write by mean curvatures H and curvature differences Δ of both bodies and the angle α between
their principal directions,

    κ_max, κ_min = H₁ + H₂ ± ½ sqrt(Δ₁² + Δ₂² + 2 Δ₁ Δ₂ cos 2α),        index = sqrt((κ_min² + κ_max²)/2)

Their index of congruence [1/m] is 0 for surfaces that fit exactly; 1/κ are equivalent radii: a sphere of that radius
on a plane is apart by as much. Each point of FIXED is paired with the nearest one of MOVING. Where the two normals are
not opposite, MOVING's tensor is turned about both by the angle between them, which leaves its curvatures as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.curvature import Curvatures, corner_shares
from geocontact.geometry.surface import Surface

FACING = np.cos(np.radians(45.0))
"""Cosine between the one normal and the other turned over from which two points face each other."""


@dataclass(frozen=True, eq=False)
class Congruence:
    """Means over FIXED's area within each threshold; NaN where nothing of it has both curvatures.

    Parameters
    ----------
    least, most
        Relative principal curvatures [1/m].
    index
        Root of the mean square of the two at each point [1/m].
    share
        Of the area within the threshold, counted by vertices, that the means are over [-]; as in the contact area,
        what is inside a closed MOVING is within, however deep.
    """

    least: Float[np.ndarray, " k"]
    most: Float[np.ndarray, " k"]
    index: Float[np.ndarray, " k"]
    share: Float[np.ndarray, " k"]


def relative_curvatures(
    total: Float[np.ndarray, "n 3 3"], normal: Float[np.ndarray, "n 3"]
) -> Float[np.ndarray, "n 2"]:
    """Eigenvalues of summed curvature tensors [1/m] in the plane at right angles to unit normals, the lesser first."""
    across = np.eye(3) - normal[:, :, None] * normal[:, None, :]
    # along the normal the value is moved away, so that the two others are those of the plane
    size = 1.0 + 2.0 * np.abs(total).sum(axis=(1, 2))
    flat = across @ total @ across + (size[:, None] * normal)[:, :, None] * normal[:, None, :]
    return np.asarray(np.linalg.eigvalsh(0.5 * (flat + flat.transpose(0, 2, 1)))[:, :2])


class CongruencePair:
    """Two surfaces whose congruence is asked for at as many poses as wanted.

    Parameters
    ----------
    moving, fixed
        The two bodies, each in its own frame.
    settings
        Thresholds and the faces that count.
    radius
        Within which curvatures are fitted [m]; see `geometry.curvature`.
    """

    def __init__(self, moving: Surface, fixed: Surface, settings: Settings, radius: float) -> None:
        self._moving, self._settings = moving, settings
        self._of_moving, self._of_fixed = Curvatures(moving, radius), Curvatures(fixed, radius)
        area = fixed.face_area if settings.fixed_faces is None else fixed.face_area * settings.fixed_faces
        corners = fixed.faces.ravel()
        self._area = np.bincount(corners, np.repeat(area / 3.0, 3), len(fixed.vertices))
        self._points = fixed.vertices

    def at(self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]) -> Congruence:
        """Congruence with MOVING at x_fixed = rotation x_moving + translation [m]."""
        counted = np.flatnonzero(self._area > 0.0)
        there = (self._points[counted] - translation) @ rotation
        near = self._moving.proximity(there, max(self._settings.thresholds))
        distance, closest, face = near.distance.copy(), near.closest.copy(), near.face.copy()
        deep = np.flatnonzero(np.isneginf(distance))  # inside, farther from the surface than was searched
        if len(deep):
            below = self._moving.proximity(there[deep])
            distance[deep], closest[deep], face[deep] = below.distance, below.closest, below.face
        close = np.flatnonzero(face >= 0)
        value = self._relative(counted[close], closest[close], face[close], rotation)
        return self._means(value, distance[close], self._area[counted[close]])

    def _relative(
        self,
        vertices: Int[np.ndarray, " n"],
        closest: Float[np.ndarray, "n 3"],
        face: Int[np.ndarray, " n"],
        rotation: Float[np.ndarray, "3 3"],
    ) -> Float[np.ndarray, "n 3"]:
        """Relative curvatures and index of FIXED's vertices; NaN where the other point looks away or has no tensor."""
        theirs, towards = self._of_other(closest, face)
        normal, back = self._of_fixed.normals[vertices], -towards @ rotation.T
        facing = np.flatnonzero(np.einsum("ni,ni->n", back, normal) >= FACING)
        turn = _turns(back[facing], normal[facing]) @ rotation
        total = self._of_fixed.tensors(vertices[facing]) + turn @ theirs[facing] @ turn.transpose(0, 2, 1)
        told = np.isfinite(total).all(axis=(1, 2))
        value = np.full((len(vertices), 3), np.nan)
        value[facing[told], :2] = relative_curvatures(total[told], normal[facing[told]])
        value[:, 2] = np.sqrt(0.5 * (value[:, 0] ** 2 + value[:, 1] ** 2))
        return value

    def _of_other(
        self, closest: Float[np.ndarray, "n 3"], face: Int[np.ndarray, " n"]
    ) -> tuple[Float[np.ndarray, "n 3 3"], Float[np.ndarray, "n 3"]]:
        """MOVING's tensors at points on its faces, linear between the corners, and its unit normals there."""
        moving = self._moving
        corners = moving.faces[face]
        share = corner_shares(moving.corners_of(face) - (closest - moving.centre)[:, None, :])
        tensors = self._of_moving.tensors(corners.ravel()).reshape(-1, 3, 3, 3)
        normal = np.einsum("nk,nki->ni", share, self._of_moving.normals[corners])
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        unit = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0)
        return np.einsum("nk,nkij->nij", share, tensors), unit

    def _means(
        self, value: Float[np.ndarray, "n 3"], distance: Float[np.ndarray, " n"], area: Float[np.ndarray, " n"]
    ) -> Congruence:
        out = np.full((4, len(self._settings.thresholds)), np.nan)
        for k, threshold in enumerate(self._settings.thresholds):
            within = distance <= threshold
            used = within & np.isfinite(value[:, 2])
            if used.any():
                out[:3, k] = area[used] @ value[used] / area[used].sum()
            if within.any():
                out[3, k] = area[used].sum() / area[within].sum()
        return Congruence(*out)


def _turns(first: Float[np.ndarray, "n 3"], then: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3 3"]:
    """Smallest rotations that bring unit vectors onto others less than 180 degrees away (Rodrigues)."""
    axis = np.cross(first, then)
    zero = np.zeros(len(axis))
    x, y, z = axis.T
    skew = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    along = 1.0 + np.einsum("ni,ni->n", first, then)
    return np.asarray(np.eye(3) + skew + skew @ skew / along[:, None, None])
