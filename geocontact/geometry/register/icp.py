"""Registration by shape: one surface moved until it lies on the other (iterative closest points, point to plane)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.boundary import on_boundary
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.samples import samples
from geocontact.geometry.surface import Surface

NORMAL = 1.4826  # standard deviation of normal residuals over their median size
BIWEIGHT = 4.685  # Tukey's constant: 95 % efficient for normal residuals
FINEST = 1e-9  # m, least scale of the residuals
SAME_SIDE = 0.5  # cosine between normals of partners: the front of a thin limb is not its back
FEW = 12  # partners that a pose takes at least


@dataclass(frozen=True)
class IcpSearch:
    """How shapes are brought together.

    Parameters
    ----------
    points
        Number of points of the moving surface that are compared.
    reach
        Largest distance of partners [m]; what is farther away has none.
    rounds
        At most.
    settled
        Motion of a round [m], at the points, below which the search ends.
    tolerance
        Residual within which points count as overlapping [m].
    """

    points: int = 4000
    reach: float = 0.05
    rounds: int = 200
    settled: float = 1e-8
    tolerance: float = 2e-3


@dataclass(frozen=True, eq=False)
class Partners:
    """Points of A in B with partners on B: signed heights above the partners' planes [m], the planes' normals.

    `number` counts them among all points.
    """

    number: Int[np.ndarray, " n"]
    points: Float[np.ndarray, "n 3"]
    normal: Float[np.ndarray, "n 3"]
    height: Float[np.ndarray, " n"]


def icp(moving: Surface, fixed: Surface, start: RigidTransform, search: IcpSearch | None = None) -> Registration:
    """The pose X_BA near `start` at which the moving surface A lies best on the fixed surface B.

    Every round, points spread evenly over A get partners: the nearest points of B. Partners on the rim of B, across a
    limb or out of reach are dropped, and what remains is weighted by Tukey's biweight with the scale estimated from the
    median, so A and B need not cover the same part. The motion that brings the points to the planes of their partners
    in the sense of least squares is a 6 x 6 system (Chen and Medioni 1992); nothing moves along what the shapes leave
    open. The faces of both surfaces must agree on what is outside.
    """
    search = search or IcpSearch()
    points, normals = samples(moving, search.points)
    pose = start
    converged, rounds = False, 0
    while rounds < search.rounds and not converged:
        rounds += 1
        partners = partners_on(fixed, pose.apply(points), pose.rotation.apply(normals), search)
        step, size = _motion(partners)
        pose = step * pose
        converged = size < search.settled
    return judged(fixed, points, normals, pose, search, converged, rounds)


def judged(
    fixed: Surface,
    points: Float[np.ndarray, "n 3"],
    normals: Float[np.ndarray, "n 3"],
    pose: RigidTransform,
    search: IcpSearch,
    converged: bool,
    rounds: int,
) -> Registration:
    """A pose X_BA with its residual map: distances of the points of A from B, and how firmly the shapes hold it."""
    there = pose.apply(points)
    residual = np.abs(fixed.proximity(there).distance)
    partners = partners_on(fixed, there, pose.rotation.apply(normals), search)
    rows, weight, _, _ = system(partners)
    spectrum = np.linalg.eigvalsh((rows * weight[:, None]).T @ rows / weight.sum())
    hold = float(np.sqrt(max(float(spectrum[0]), 0.0)))
    return Registration(pose, there, residual, search.tolerance, (), converged, rounds, hold)


def partners_on(
    fixed: Surface, points: Float[np.ndarray, "n 3"], normals: Float[np.ndarray, "n 3"], search: IcpSearch
) -> Partners:
    """Partners on B of points of A with their outward normals; refused where there are too few."""
    found = fixed.proximity(points, search.reach)
    near = np.flatnonzero(found.face >= 0)
    face, closest = found.face[near], found.closest[near]
    plane = fixed.face_normal[face]
    kept: Bool[np.ndarray, " k"] = np.einsum("ij,ij->i", plane, normals[near]) > SAME_SIDE
    kept &= ~on_boundary(fixed, closest, face)
    if kept.sum() < FEW:
        raise ValueError(
            f"{kept.sum()} of {len(points)} points find a partner on {fixed.name} within {search.reach:g} m that faces "
            "the same way; begin nearer, by landmarks"
        )
    height = np.einsum("ij,ij->i", points[near] - closest, plane)
    return Partners(near[kept], points[near][kept], plane[kept], height[kept])


def system(
    partners: Partners,
) -> tuple[Float[np.ndarray, "n 6"], Float[np.ndarray, " n"], Float[np.ndarray, " 3"], float]:
    """Change of every height with a shift and a turn about the points' middle (over their spread), and weights."""
    middle = partners.points.mean(axis=0)
    arm = partners.points - middle
    spread = float(np.sqrt((arm**2).sum(axis=1).mean()))
    scale = BIWEIGHT * max(NORMAL * float(np.median(np.abs(partners.height))), FINEST)
    weight = np.maximum(1.0 - (partners.height / scale) ** 2, 0.0) ** 2
    return np.column_stack([partners.normal, np.cross(arm / spread, partners.normal)]), weight, middle, spread


def _motion(partners: Partners) -> tuple[RigidTransform, float]:
    """The motion of one round and its size at the points [m]."""
    rows, weight, middle, spread = system(partners)
    root = np.sqrt(weight)
    x = np.linalg.lstsq(rows * root[:, None], -partners.height * root, rcond=1e-4)[0]
    turn = Rotation.from_rotvec(x[3:] / spread)
    return RigidTransform.from_components(middle + x[:3] - turn.apply(middle), turn), float(np.linalg.norm(x))
