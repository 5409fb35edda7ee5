"""Reference areas of two triangulated bodies by adaptive subdivision with libigl, independent of geocontact.

The area asked for is that of {x on A's faces: signed distance to B <= T}. A signed distance is 1-Lipschitz, so a
triangle with centroid distance d and circumscribed radius rho (of the ball about its centroid) lies wholly inside when
d + rho <= T and wholly outside when d - rho > T; the others are cut in four. What is decided bounds the area from below
and above; the estimate adds the undecided leaves cut at the iso-line of the distance linear between their corners.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import version

import igl
import numpy as np

SOURCE = f"converged by adaptive subdivision with libigl {version('libigl')}"

Body = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Area:
    """Estimate, its uncertainty (change over the last halving of the leaves) and rigorous bounds [mm^2]."""

    estimate: float
    uncertainty: float
    lower: float
    upper: float


def signed_distance(points: np.ndarray, body: Body) -> np.ndarray:
    """Signed distance [mm] of points to a closed surface, negative inside (winding number above 1/2)."""
    if len(points) == 0:
        return np.empty(0)
    squared = igl.point_mesh_squared_distance(points, *body)[0]
    inside = igl.fast_winding_number(*body, points) > 0.5
    return np.where(inside, -1.0, 1.0) * np.sqrt(squared)


def quartered(triangles: np.ndarray) -> np.ndarray:
    """Each triangle (n, 3, 3) cut at its edge midpoints into four."""
    a, b, c = (triangles[:, k] for k in range(3))
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack(p, axis=1) for p in parts], axis=1).reshape(-1, 3, 3)


def areas(triangles: np.ndarray) -> np.ndarray:
    """Area of each triangle."""
    return np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2


def centroids_and_radii(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centroids and the distance of the farthest corner from them."""
    centroid = triangles.mean(axis=1)
    return centroid, np.linalg.norm(triangles - centroid[:, None], axis=2).max(axis=1)


def fraction_below(values: np.ndarray, threshold: float) -> np.ndarray:
    """Part of each triangle where the linear function with corner values (n, 3) is <= threshold."""
    low, middle, high = np.sort(values - threshold, axis=1).T
    with np.errstate(divide="ignore", invalid="ignore"):
        tip_low = low**2 / ((middle - low) * (high - low))
        tip_high = high**2 / ((high - low) * (high - middle))
    return np.select([high <= 0, low > 0, middle > 0], [1.0, 0.0, tip_low], 1 - tip_high)


def clipped_area(triangles: np.ndarray, body: Body, threshold: float) -> float:
    """Area of the triangles within the threshold, distance linear in each."""
    corners, which = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    distance = signed_distance(corners, body)[which.reshape(-1, 3)]
    return float(fraction_below(distance, threshold) @ areas(triangles))


def area_within(of: Body, to: Body, threshold: float, width: float = 2e-4, most: int = 400_000) -> Area:
    """Area of `of` within `threshold` [mm] of `to`; both closed, in one frame, vertices in mm.

    Stops when (upper - lower) / upper < `width` or when more than `most` leaves would be undecided.
    """
    triangles = of[0][of[1]]
    inside, estimates = 0.0, []
    while True:
        centroid, radius = centroids_and_radii(triangles)
        distance, size = signed_distance(centroid, to), areas(triangles)
        inside += float(size[distance + radius <= threshold].sum())
        cut = (distance - radius <= threshold) & (distance + radius > threshold)
        triangles, undecided = triangles[cut], float(size[cut].sum())
        estimates.append(inside + clipped_area(triangles, to, threshold))
        done = undecided <= width * (inside + undecided)
        if len(estimates) > 1 and (done or 4 * len(triangles) > 2 * most):
            change = abs(estimates[-1] - estimates[-2])
            # Where the distance is linear the change is nothing but rounding.
            return Area(estimates[-1], max(change, 1e-9 * estimates[-1]), inside, inside + undecided)
        triangles = quartered(triangles)


def smallest_distance(one: Body, other: Body, tolerance: float = 1e-4, most: int = 400_000) -> tuple[float, float]:
    """Bounds (lower, upper) [mm] of the smallest signed distance over both whole surfaces, faces included."""
    bounds = []
    for of, to in ((one, other), (other, one)):
        triangles, best = of[0][of[1]], np.inf
        while True:
            centroid, radius = centroids_and_radii(triangles)
            distance = signed_distance(centroid, to)
            best = min(best, float(distance.min()))
            least = float((distance - radius).min())
            if best - least <= tolerance or 4 * len(triangles) > most:
                bounds.append((least, best))
                break
            triangles = quartered(triangles[distance - radius < best - tolerance / 2])
    return min(b[0] for b in bounds), min(b[1] for b in bounds)
