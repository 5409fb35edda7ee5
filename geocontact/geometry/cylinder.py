"""The cylinder that fits a surface best: an axis for turning a component about."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

STARTS = 24  # directions over the half-sphere


@dataclass(frozen=True)
class Cylinder:
    """Axis through `point` [m] along the unit vector `direction`, radius [m], root mean square distance [m]."""

    point: Float[np.ndarray, " 3"]
    direction: Float[np.ndarray, " 3"]
    radius: float
    rms: float


def fit_cylinder(points: Float[np.ndarray, "n 3"], loss_scale: float = 5e-4) -> Cylinder:
    """Geometric least squares with a Cauchy loss, from several starting directions; the best of them is returned.

    Residuals are distances to the cylinder's wall; `loss_scale` [m] is the distance beyond which points count less.
    At least 6 points. Partial arcs down to about 60 degrees are determined, flatter ones are not.
    """
    if len(points) < 6:
        raise ValueError(f"a cylinder needs at least 6 points, not {len(points)}")
    some = points if len(points) <= 4000 else points[np.random.default_rng(0).permutation(len(points))[:4000]]
    middle = some.mean(axis=0)
    size = float(np.abs(some - middle).max())
    local = (some - middle) / size
    fits = [_from(local, start, loss_scale / size) for start in _half_sphere(STARTS)]
    best = min(fits, key=lambda fit: fit[0])
    _, frame, x = best
    direction, radius, point = _unpack(x, frame)
    residual = _distance(local, point, direction) - radius
    rms = float(np.sqrt(np.mean(residual**2))) * size
    return Cylinder(middle + size * point, direction, float(radius) * size, rms)


def _half_sphere(count: int) -> list[Float[np.ndarray, " 3"]]:
    """Nearly even directions on the half-sphere (Fibonacci lattice)."""
    z = (np.arange(count) + 0.5) / count
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    ring = np.sqrt(1.0 - z * z)
    return list(np.stack([ring * np.cos(turn), ring * np.sin(turn), z], axis=1))


def _frame(direction: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """Rows: two unit vectors across the direction, and the direction."""
    spare = np.eye(3)[int(np.argmin(np.abs(direction)))]
    u = np.cross(direction, spare)
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(direction, u), direction])


def _unpack(
    x: Float[np.ndarray, " 5"], frame: Float[np.ndarray, "3 3"]
) -> tuple[Float[np.ndarray, " 3"], float, Float[np.ndarray, " 3"]]:
    tilt = np.array([x[0], x[1], 1.0]) @ frame
    return tilt / np.linalg.norm(tilt), abs(float(x[4])), np.array([x[2], x[3], 0.0]) @ frame


def _distance(
    points: Float[np.ndarray, "n 3"], point: Float[np.ndarray, " 3"], direction: Float[np.ndarray, " 3"]
) -> Float[np.ndarray, " n"]:
    return np.asarray(np.linalg.norm(np.cross(points - point, direction), axis=1))


def _from(
    local: Float[np.ndarray, "n 3"], start: Float[np.ndarray, " 3"], scale: float
) -> tuple[float, Float[np.ndarray, "3 3"], Float[np.ndarray, " 5"]]:
    frame = _frame(start)
    across = local @ frame[:2].T
    # algebraic circle through the projected points: a start for centre and radius
    rows = np.column_stack([2.0 * across, np.ones(len(across))])
    solution = np.linalg.lstsq(rows, (across**2).sum(axis=1), rcond=None)[0]
    radius = float(np.sqrt(max(solution[2] + solution[:2] @ solution[:2], 1e-6)))

    def residual(x: Float[np.ndarray, " 5"]) -> Float[np.ndarray, " n"]:
        direction, r, point = _unpack(x, frame)
        return _distance(local, point, direction) - r

    x0 = np.array([0.0, 0.0, solution[0], solution[1], radius])
    fit = least_squares(residual, x0, loss="cauchy", f_scale=scale, max_nfev=200)
    return float(fit.cost), frame, fit.x
