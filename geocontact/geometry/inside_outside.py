"""Inside or outside, where normals alone cannot be trusted: the winding number decides, or says that it cannot.

libigl evaluates winding numbers in single precision: within about 1e-7 of the body's size of the surface they may give
the wrong side, an error of the signed distance of 1e-8 m on an implant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Bool, Float, Int, Int8
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

if TYPE_CHECKING:
    from geocontact.geometry.kernels.binary import Binary

Body = Any
"""A `geometry.surface.Surface`, which is made of what is found here."""

UNDECIDED = 0.2  # |w - 0.5| below which a winding number gives no side
SINGLE = 1e-6  # share of the body's size that single precision resolves for certain
WITNESSES = 5  # faces that speak for a patch
PROBES = 2000  # points at which normals are compared with winding numbers before they are trusted


def doubtful_faces(surface: Body, binary: Binary) -> Bool[np.ndarray, " m"]:
    """Faces whose normals would misplace points: those at a self-intersection, and patches that are no boundary.

    Self-intersections cut a surface into patches. On either side of a patch the winding number is constant; where it is
    not 0 in front and 1 behind, the patch is buried in another part or turned over. The segment from a point to its
    nearest face crosses nothing, so the sides of all other points are read from normals without doubt.
    """
    from geocontact.geometry.kernels.self_intersection import pierced  # late: numba, for jobs without a surface

    merged = surface.topology.merged[surface.faces]
    marked = pierced(binary, surface.corners, merged)
    touched = np.zeros(len(surface.vertices), bool)
    touched[merged[marked].ravel()] = True
    doubtful = np.asarray(touched[merged].any(axis=1))
    clear = np.flatnonzero(~doubtful)
    if len(clear) == 0:
        return doubtful
    patch = _patches(merged[clear], len(surface.vertices))
    for number in range(patch.max() + 1):
        members = clear[patch == number]
        doubtful[members] = not _is_boundary(surface, members)
    return doubtful


def _patches(faces: Int[np.ndarray, "k 3"], count: int) -> Int[np.ndarray, " k"]:
    """Number of the connected patch of each face."""
    ends = np.concatenate([faces[:, :2], faces[:, 1:]])
    graph = coo_array((np.ones(len(ends), np.int8), (ends[:, 0], ends[:, 1])), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    return np.asarray(np.unique(label[faces[:, 0]], return_inverse=True)[1])


def _is_boundary(surface: Body, members: Int[np.ndarray, " k"]) -> bool:
    """Whether most of the largest faces of a patch have the outside in front and the inside behind."""
    largest = members[np.argsort(-surface.face_area[members], kind="stable")[:WITNESSES]]
    middle = surface.corners_of(largest).mean(axis=1)
    step = 0.05 * np.sqrt(surface.face_area[largest])[:, None] * surface.face_normal[largest]
    front, back = winding_signs(surface, middle + step), winding_signs(surface, middle - step)
    return bool(2 * np.count_nonzero((front == 1) & (back == -1)) > len(largest))


def winding_signs(surface: Body, local: Float[np.ndarray, "n 3"]) -> Int8[np.ndarray, " n"]:
    """Side of each point (about the surface's centre) by winding number: 1 outside, -1 inside, 0 undecided."""
    if len(local) == 0:
        return np.zeros(0, np.int8)
    w = np.asarray(surface.winding.winding_number(np.ascontiguousarray(local)))
    if surface.inside_out:
        w = -w
    side = np.where(w > 0.5, -1, 1).astype(np.int8)
    side[np.abs(w - 0.5) < UNDECIDED] = 0
    return side


def normals_agree(surface: Body) -> bool:
    """Whether sides from normals agree with winding numbers at probes close to the faces and around the body.

    They do on a sound closed body; they do not where components overlap or a patch is turned over.
    """
    return disagreement(surface) == 0.0


def disagreement(surface: Body) -> float:
    """Share of probes where the side by normals differs from the side by winding number, 0 for a sound closed body."""
    from geocontact.geometry.kernels.batch import chunk_spheres, signed_distances  # late: numba

    rng = np.random.default_rng(0)
    some = rng.permutation(len(surface.faces))[: PROBES // 4]
    step = 0.25 * np.sqrt(surface.face_area[some])[:, None] * surface.face_normal[some]
    middle = surface.corners_of(some).mean(axis=1)
    box = surface.tree.root
    around = rng.uniform(box[:3], box[3:], (PROBES // 2, 3))
    probes = np.concatenate([middle + step, middle - step, around])
    limits = np.full(len(probes), np.inf)
    spheres = chunk_spheres(probes, limits)
    distance, side, _, _ = signed_distances(surface.tree, probes, limits, spheres, True)
    clear = distance > 1e-7 * np.linalg.norm(box[3:] - box[:3])
    differs = (side != 0) & (side != winding_signs(surface, probes)) & clear
    return float(differs.mean())


def resolve_inside_outside(
    surface: Body, local: Float[np.ndarray, "n 3"], side: Int8[np.ndarray, " n"], distance: Float[np.ndarray, " n"]
) -> tuple[Int8[np.ndarray, " n"], int]:
    """Sides with doubts settled by winding number, and how many points off the surface stayed undecided.

    Those are taken as outside, as are points beyond the body's box and those on the surface itself, where the side does
    not matter.
    """
    if not surface.closed:
        return side, 0
    root = surface.tree.root
    ask = side == 0
    if not surface.normals_trusted:
        ask = ((local > root[:3]) & (local < root[3:])).all(axis=1)
        side = np.where(ask, side, np.int8(1))
    if not ask.any():
        return side, 0
    side = side.copy()
    side[ask] = winding_signs(surface, local[ask])
    undecided = side == 0
    side[undecided] = 1
    return side, int(np.count_nonzero(undecided & (distance > SINGLE * np.linalg.norm(root[3:] - root[:3]))))
