"""Registration by shape: one surface moved until it lies on the other, with or without a pose to start from, and its
covariance.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.sparse import coo_array
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.register.quality import PoseCovariance, Registration
from geocontact.geometry.surface import Surface, on_boundary

GOLDEN = 0.7548776662466927, 0.5698402909980532
"""Inverse powers of the plastic number: the additive recurrence with the evenest spread in the plane (Roberts 2018)."""


def samples(surface: Surface, number: int) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
    """Points [m] and outward face normals there, one per equal share of the area; faces that repeat count once."""
    face, weights = sampled(surface, number)
    return np.einsum("nk,nki->ni", weights, surface.vertices[surface.faces[face]]), surface.face_normal[face]


def sampled(surface: Surface, number: int) -> tuple[Int[np.ndarray, " n"], Float[np.ndarray, "n 3"]]:
    """The same points as faces and shares of their corners."""
    area = np.where(surface.repeated, 0.0, surface.face_area)
    total = np.cumsum(area)
    if not total[-1] > 0.0:
        raise ValueError(f"{surface.name}: a surface without area has no points to compare")
    k = np.arange(number)
    face = np.searchsorted(total, (k + 0.5) / number * total[-1], side="right")
    s, t = (np.mod(0.5 + g * k, 1.0) for g in GOLDEN)
    over = s + t > 1.0
    s, t = np.where(over, 1.0 - s, s), np.where(over, 1.0 - t, t)
    return face, np.column_stack([1.0 - s - t, s, t])


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


TWISTS = 12  # turns about the longest axis that are tried, both ways up
ROUGH = IcpSearch(points=400, rounds=25, settled=1e-5)
POINTS = 4000  # that principal axes are taken from
BEST = 3  # starts that are followed to the end
PLAINLY = 0.9  # another start must fit that much better than the scans as they stand


def unguided(moving: Surface, fixed: Surface, search: IcpSearch | None = None) -> Registration:
    """The pose X_BA at which a scan A lies best on another scan B of the same body.

    Starts are A as it stands, and A with its centroid and longest principal axis on those of B, turned about that axis
    in steps of 30 degrees, both ways up. Each is followed roughly by `icp`, the best three to the end. What fits is
    estimated from the median residual, so that a part that only one scan has does not count. Bodies that are alike from
    several sides have several answers: the one that needs no turn is preferred.
    """
    rated = []
    for k, start in enumerate(_starts(moving, fixed)):
        try:
            found = icp(moving, fixed, start, ROUGH)
        except ValueError:
            continue
        rated.append((_misfit(found) * (PLAINLY if k == 0 else 1.0), k, found.pose))
    if not rated:
        raise ValueError(f"{moving.name} and {fixed.name} find no partners in any pose; are they of the same body?")
    finished = [(icp(moving, fixed, pose, search), k) for _, k, pose in sorted(rated, key=lambda r: r[:2])[:BEST]]
    return min(finished, key=lambda f: (_misfit(f[0]) * (PLAINLY if f[1] == 0 else 1.0), f[1]))[0]


def _misfit(found: Registration) -> float:
    return float(np.median(found.residual))


def _starts(moving: Surface, fixed: Surface) -> Iterator[RigidTransform]:
    yield RigidTransform.identity()
    (a, from_A), (b, from_B) = (_axes(surface) for surface in (moving, fixed))
    for up in (1.0, -1.0):
        flip = np.diag([up, 1.0, up])
        for k in range(TWISTS):
            twist = Rotation.from_rotvec([0.0, 0.0, 2.0 * np.pi * k / TWISTS]).as_matrix()
            turn = Rotation.from_matrix(b @ twist @ flip @ a.T)
            yield RigidTransform.from_components(from_B - turn.apply(from_A), turn)


def _axes(surface: Surface) -> tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, " 3"]]:
    """Principal axes as right-handed columns, the longest last, and the centroid."""
    points, _ = samples(surface, POINTS)
    centre = points.mean(axis=0)
    _, axes = np.linalg.eigh(np.cov((points - centre).T))
    axes[:, 0] *= np.sign(np.linalg.det(axes))
    return axes, centre


def same_place(moving: Surface, found: Registration) -> Surface:
    """A in B's frame."""
    return replace(moving, vertices=found.pose.apply(moving.vertices))


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
