"""Inside or outside, where normals alone cannot be trusted: the winding number decides, or says that it cannot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int, Int8

from geocontact.geometry.kernels.binary import Binary
from geocontact.geometry.kernels.batch import chunk_spheres, signed_distances
from geocontact.geometry.kernels.tangle import pierced

if TYPE_CHECKING:
    from geocontact.geometry.surface import Surface

UNDECIDED = 0.2  # |w - 0.5| below which a winding number gives no side
PROBES = 4000  # points at which normals are compared with winding numbers before they are trusted


def tangled(
    binary: Binary, corners: Float[np.ndarray, "m 3 3"], merged: Int[np.ndarray, "m 3"]
) -> Bool[np.ndarray, " m"]:
    """Faces that touch a self-intersection: their normals would misplace points, winding numbers do not."""
    marked = pierced(binary, corners, merged)
    near = np.zeros(int(merged.max()) + 1, bool)
    near[merged[marked].ravel()] = True
    return np.asarray(near[merged].any(axis=1))


def winding_sides(surface: Surface, local: Float[np.ndarray, "n 3"]) -> Int8[np.ndarray, " n"]:
    """Side of each point (about the surface's centre) by winding number: 1 outside, -1 inside, 0 undecided."""
    if len(local) == 0:
        return np.zeros(0, np.int8)
    w = np.asarray(surface.winding.winding_number(np.ascontiguousarray(local)))
    if surface.inside_out:
        w = -w
    side = np.where(w > 0.5, -1, 1).astype(np.int8)
    side[np.abs(w - 0.5) < UNDECIDED] = 0
    return side


def normals_agree(surface: Surface) -> bool:
    """Whether sides from normals agree with winding numbers at probes close to the faces and around the body.

    They do on a sound closed body; they do not where components overlap or a patch is turned over.
    """
    return disagreement(surface) == 0.0


def disagreement(surface: Surface) -> float:
    """Share of probes where the side by normals differs from the side by winding number, 0 for a sound closed body."""
    rng = np.random.default_rng(0)
    some = rng.permutation(len(surface.faces))[: PROBES // 4]
    step = 0.25 * np.sqrt(surface.face_area[some])[:, None] * surface.face_normal[some]
    middle = surface.corners[some].mean(axis=1)
    box = surface.tree.root
    around = rng.uniform(box[:3], box[3:], (PROBES // 2, 3))
    probes = np.concatenate([middle + step, middle - step, around])
    limits = np.full(len(probes), np.inf)
    spheres = chunk_spheres(probes, limits)
    distance, side, _, _ = signed_distances(surface.tree, probes, limits, spheres, True)
    clear = distance > 1e-7 * np.linalg.norm(box[3:] - box[:3])
    differs = (side != 0) & (side != winding_sides(surface, probes)) & clear
    return float(differs.mean())


def resolve_sides(
    surface: Surface, local: Float[np.ndarray, "n 3"], side: Int8[np.ndarray, " n"]
) -> tuple[Int8[np.ndarray, " n"], int]:
    """Sides with doubts settled by winding number, and how many points stayed undecided (taken as outside)."""
    if not surface.closed:
        return side, 0
    ask = side == 0
    if not surface.normals_trusted:
        box = surface.tree.root
        ask = ((local > box[:3]) & (local < box[3:])).all(axis=1)
    if not ask.any():
        return side, 0
    side = side.copy()
    side[ask] = winding_sides(surface, local[ask])
    undecided = side == 0
    side[undecided] = 1
    return side, int(undecided.sum())
