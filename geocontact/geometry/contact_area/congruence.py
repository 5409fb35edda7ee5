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

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.curvature import Curvatures, corner_shares
from geocontact.geometry.surface import Surface

FACING = np.cos(np.radians(45.0))
"""Cosine between the one normal and the other turned over from which two points face each other."""
EDGES = (2.5, 3.5, 5.0)
"""Radii that are tried in place of one that is too short, in median edges of the coarser mesh: 2.5 reach a vertex's
second neighbours."""
ENOUGH = 0.5
"""Share of the contact area with both curvatures from which such a radius is long enough."""
PER_MM = 1e-3


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


@dataclass(frozen=True, eq=False)
class CongruenceEvolution:
    """Congruence of two surfaces over a motion: means over FIXED's area, over frames (t) and thresholds (k).

    Parameters
    ----------
    least, most, index
        Relative principal curvatures and index of congruence [1/m]; NaN where nothing is near, or too little known.
    share
        Of the contact area that the means are over [-].
    """

    least: Float[np.ndarray, "t k"]
    most: Float[np.ndarray, "t k"]
    index: Float[np.ndarray, "t k"]
    share: Float[np.ndarray, "t k"]

    def columns(self) -> dict[str, Float[np.ndarray, " r"]]:
        """Columns of a table, frames outer and thresholds inner, as in `AreaEvolution.table`."""
        return {
            "relative_curvature_min [1/mm]": self.least.ravel() * PER_MM,
            "relative_curvature_max [1/mm]": self.most.ravel() * PER_MM,
            "congruence_index [1/mm]": self.index.ravel() * PER_MM,
            "congruence_share [-]": self.share.ravel(),
        }

    def above(self, share: float) -> CongruenceEvolution:
        """The same with NaN where less than this share of the contact area has both curvatures."""
        few = self.share < share
        least, most, index = (np.where(few, np.nan, part) for part in (self.least, self.most, self.index))
        return CongruenceEvolution(least, most, index, self.share)


def congruence_evolution(
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    settings: Settings,
    radius: float,
    step: Callable[[], None] = lambda: None,
) -> CongruenceEvolution:
    """Congruence of two surfaces in every frame of a motion.

    Parameters
    ----------
    moving, fixed
        The two bodies, each in its own frame [m].
    motion
        Poses of MOVING in FIXED.
    settings
        Thresholds and the faces that count.
    radius
        Within which curvatures are fitted [m].
    step
        Called after each frame.
    """
    pair = CongruencePair(moving, fixed, settings, radius)
    frames = []
    for rotation, translation in _poses(motion):
        frames.append(pair.at(rotation, translation))
        step()
    parts = ("least", "most", "index", "share")
    return CongruenceEvolution(*(np.array([getattr(each, part) for each in frames]) for part in parts))


def longer_radius(
    moving: Surface, fixed: Surface, motion: Motion, settings: Settings, radius: float, found: CongruenceEvolution
) -> float | None:
    """A longer radius [m] within which at least `ENOUGH` of the contact area has both curvatures; None where none does.

    Radii of `EDGES` median edges of the coarser mesh, rounded up to 0.1 mm, are tried in turn, in the frame and at the
    threshold of the largest share in `found`, which `radius` led to.
    """
    share = np.where(np.isfinite(found.share), found.share, -1.0)
    frame, k = np.unravel_index(int(np.argmax(share)), share.shape)
    rotation, translation = _poses(motion)[int(frame)]
    longest = max(median_edges(moving, fixed))
    for each in (float(np.ceil(factor * longest * 1e4) * 1e-4) for factor in EDGES):
        if each <= radius:
            continue
        if CongruencePair(moving, fixed, settings, each).at(rotation, translation).share[k] >= ENOUGH:
            return each
    return None


def median_edges(moving: Surface, fixed: Surface) -> tuple[float, float]:
    """Median edge of each mesh [m]."""
    return float(np.median(moving.edge_length)), float(np.median(fixed.edge_length))


def _poses(motion: Motion) -> list[tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, " 3"]]]:
    rotation = motion.poses.rotation.as_matrix().reshape(-1, 3, 3)
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    return list(zip(rotation, translation, strict=True))
