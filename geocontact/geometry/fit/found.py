"""What a fit returns: the shape, the residual of every point, and how well the shape is known.

A surface is not a cylinder plus independent noise: where it departs from one, all points nearby depart together, and
an interval that counts them as independent shrinks with every refinement of the mesh. Points are therefore grouped into
compact cells, and the covariance is that of leaving out one cell after the other (delete-one-cluster jackknife of the
linearised M-estimator; Bell and McCaffrey 2002, Survey Methodology 28, 169-181, their estimator CR3):

    d_g = (A - A_g)^-1 s_g,   cov = (G - 1) / G  sum_g (d_g - mean d) (d_g - mean d)^T

with s_g = sum psi(r_i) J_i and A_g = sum psi'(r_i) J_i J_i^T over the points of cell g. It holds as long as errors are
alike over distances smaller than a cell, a quarter of the patch. Few points are their own cells and independent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.special import stdtrit

from geocontact.geometry.fit.solver import FINEST, M, Solution, solve, spread
from geocontact.geometry.sweep import Axis

LEVELS = 4  # halvings: 16 cells
POINTS = 16  # a cell holds at least; with fewer in all every point is one


def cells(points: Float[np.ndarray, "n 3"]) -> Int[np.ndarray, " n"]:
    """Number of the cell of each point: halved at the median of the longest side, four times."""
    if len(points) < POINTS * 2**LEVELS:
        return np.arange(len(points))
    found = np.zeros(len(points), np.int64)
    groups = [np.arange(len(points))]
    for _ in range(LEVELS):
        groups = [half for group in groups for half in _halves(points, group)]
    for number, group in enumerate(groups):
        found[group] = number
    return found


def _halves(points: Float[np.ndarray, "n 3"], group: Int[np.ndarray, " k"]) -> tuple[np.ndarray, np.ndarray]:
    own = points[group]
    order = np.argpartition(own[:, int(np.argmax(np.ptp(own, axis=0)))], len(group) // 2)
    return group[order[: len(group) // 2]], group[order[len(group) // 2 :]]


def covariance(
    residual: Float[np.ndarray, " n"],
    jacobian: Float[np.ndarray, "n p"],
    scale: float | None,
    cell: Int[np.ndarray, " n"],
) -> Float[np.ndarray, "p p"]:
    """Covariance of the parameters; `scale` is that of the biweight, None for least squares.

    Infinite where the points do not determine the parameters.
    """
    square = (residual / (scale or np.inf)) ** 2
    left = np.maximum(1.0 - square, 0.0)
    pull, slope = left**2 * residual, left * (1.0 - 5.0 * square)
    count = int(cell.max()) + 1
    score = np.stack([np.bincount(cell, pull * column, count) for column in jacobian.T], axis=1)
    p = jacobian.shape[1]
    bread = np.empty((count, p, p))
    for j in range(p):
        for k in range(j, p):
            bread[:, j, k] = bread[:, k, j] = np.bincount(cell, slope * jacobian[:, j] * jacobian[:, k], count)
    whole = bread.sum(axis=0)
    if count <= p or not np.linalg.cond(whole) < 1.0 / np.finfo(float).eps:
        return np.full((p, p), np.inf)
    moved = np.linalg.solve(whole - bread, score[:, :, None])[:, :, 0]
    moved -= moved.mean(axis=0)
    return np.asarray((count - 1.0) / count * moved.T @ moved)


def half_width(variance: float, cell: Int[np.ndarray, " n"], parameters: int) -> float:
    """Half the 95 % interval of a parameter of that variance: Student's t with the cells' degrees of freedom."""
    count = int(cell.max()) + 1
    free = count - 1 if count < len(cell) else count - parameters
    if free < 1 or not np.isfinite(variance):
        return float(np.inf)
    return float(stdtrit(free, 0.975) * np.sqrt(variance))


HELD = 0.98  # share of the inliers that an arc is to hold
MOSTLY = 0.9  # of the points; fewer that lie on a shape are a part of them
EXACT = 1e-3  # of the root mean square of all points, that of those on a constructed shape is below
OUTLYING = 3.0  # standard deviations beyond which a point is called an outlier


@dataclass(frozen=True, eq=False)
class Quality:
    """Residuals of a fit and the covariance of its parameters, SI units.

    Parameters
    ----------
    residual
        Signed distance of every point to the shape [m]: positive outside a cylinder or sphere, above a plane.
    noise
        Standard deviation of the residuals estimated from their median size [m]; without outliers that of normal noise.
    inlier
        Points within three times `noise`.
    names, covariance
        Parameters with their units, and the covariance between them, from groups of neighbouring points.
    half_widths
        Half the 95 % interval of each parameter; infinite where the points do not tell.
    converged
        Whether the search ended by itself.
    """

    residual: Float[np.ndarray, " n"]
    noise: float
    inlier: Bool[np.ndarray, " n"]
    names: tuple[str, ...]
    covariance: Float[np.ndarray, "p p"]
    half_widths: Float[np.ndarray, " p"]
    converged: bool


@dataclass(frozen=True, eq=False)
class ShapeFit:
    """A fitted shape, in the frame of the points.

    Parameters
    ----------
    shape
        "cylinder", "sphere" or "plane".
    point
        On the axis, beside the middle of the points; the centre; on the plane, below the middle of the points [m].
    axis
        Unit vector along the axis, or normal of the plane; its largest component is positive. None for a sphere.
    radius
        [m]; None for a plane.
    arc
        Angle about the axis that the inliers cover [rad]; of a sphere the opening angle of the cone that holds them,
        from its centre; 0 for a plane.
    """

    shape: str
    point: Float[np.ndarray, " 3"]
    axis: Float[np.ndarray, " 3"] | None
    radius: float | None
    arc: float
    quality: Quality

    @property
    def line(self) -> Axis:
        """The axis, or the normal of a plane, as a line."""
        if self.axis is None:
            raise ValueError(f"a {self.shape} has no axis")
        (x, y, z), (u, v, w) = self.point.tolist(), self.axis.tolist()
        return Axis((x, y, z), (u, v, w))

    def distance(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Signed distance of any points to the shape [m], with the sign of the residuals."""
        offset = points - self.point
        if self.axis is not None:
            height = offset @ self.axis
            if self.radius is None:
                return np.asarray(height)
            offset = offset - height[:, None] * self.axis
        return np.asarray(np.linalg.norm(offset, axis=1) - (self.radius or 0.0))

    @property
    def rms(self) -> float:
        """Root mean square distance of all points, outliers included [m]."""
        return float(np.sqrt(np.mean(self.quality.residual**2)))

    @property
    def rms_inliers(self) -> float:
        """Root mean square distance of the inliers [m]."""
        return float(np.sqrt(np.mean(self.quality.residual[self.quality.inlier] ** 2)))

    @property
    def mean_abs(self) -> float:
        """Mean distance of all points from the shape [m]."""
        return float(np.abs(self.quality.residual).mean())

    @property
    def max_abs(self) -> float:
        """Largest distance of a point from the shape [m]."""
        return float(np.abs(self.quality.residual).max())

    @property
    def exact_in_part(self) -> bool:
        """Whether some points lie on the shape by construction and many others off it.

        Residuals of those on it are rounding, so that an interval made of them has no width, whatever the others are.
        """
        return bool(self.quality.inlier.mean() < MOSTLY and self.rms_inliers < EXACT * self.rms)

    @property
    def radius_interval(self) -> tuple[float, float] | None:
        """95 % interval of the radius [m]; None for a plane, where the points do not tell, and if `exact_in_part`."""
        if self.radius is None or self.exact_in_part or not np.isfinite(self.quality.half_widths[-1]):
            return None
        half = float(self.quality.half_widths[-1])
        return self.radius - half, self.radius + half


def local(points: Float[np.ndarray, "n 3"]) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, " 3"], float]:
    """Points about their middle in units of their size, the middle, and the size [m]."""
    if not np.isfinite(points).all():
        raise ValueError("points to fit must be finite")
    middle = points.mean(axis=0)
    size = float(np.abs(points - middle).max())
    if size == 0.0:
        raise ValueError("all points to fit are the same")
    return (points - middle) / size, middle, size


def fitted(
    here: Float[np.ndarray, "n 3"], size: float, starts: Sequence[M], robust: bool
) -> tuple[Solution[M], Quality]:
    """Best shape from several starts to points that `local` gave, with what is known of it in SI units."""
    solution = solve(here, starts, robust)
    model = solution.model
    residual = model.residual(model.x, here)
    noise = spread(residual)
    cell = cells(here)
    scales = np.where(model.lengths, size, 1.0)
    cov = covariance(residual, model.jacobian(model.x, here), solution.scale, cell) * np.outer(scales, scales)
    half = np.array([half_width(float(v), cell, len(scales)) for v in np.diag(cov)])
    inlier = np.abs(residual) <= OUTLYING * noise + FINEST
    return solution, Quality(residual * size, noise * size, inlier, model.names, cov, half, solution.converged)


def arc_covered(angle: Float[np.ndarray, " n"]) -> float:
    """Shortest arc that holds 98 % of the angles, over 0.98: what evenly spread ones cover, strays aside [rad]."""
    ordered = np.sort(angle)
    held = int(np.ceil(HELD * len(ordered)))
    ends = np.concatenate([ordered, ordered + 2.0 * np.pi])[held - 1 : held - 1 + len(ordered)]
    return min(float((ends - ordered).min()) / HELD, 2.0 * np.pi)
