"""Synthetic points on a part of a cylinder's wall, with noise and outliers, turned and shifted."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

TURN, SHIFT = Rotation.from_rotvec([0.3, -1.1, 0.7]), np.array([0.1, -0.4, 0.25])
RADIUS, LENGTH = 0.037, 0.06


def wall(arc, count=1000, length=LENGTH, seed=0):
    """Angle [rad] and height of points on a part of a cylinder's wall."""
    rng = np.random.default_rng(seed)
    return np.radians(rng.uniform(-arc / 2, arc / 2, count)), rng.uniform(-length / 2, length / 2, count)


def points(angle, height, radius=RADIUS, turn=TURN, shift=SHIFT):
    """Points about the turned and shifted z axis; radius one number or one per point."""
    return turn.apply(np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])) + shift


def noisy(arc, count, seed, noise=1e-4):
    """Wall with normal noise [m] across it."""
    return points(*wall(arc, count, seed=seed), RADIUS + noise * np.random.default_rng(seed + 1).normal(size=count))


def spoilt(arc, count, seed, kind):
    """The same with a fifth of outliers: anywhere, inside the wall, or on another face of the body."""
    cloud = noisy(arc, count, seed)
    rng, k = np.random.default_rng(seed + 2), count // 5
    if kind == "anywhere":
        cloud[:k] += rng.uniform(-0.6 * RADIUS, 0.6 * RADIUS, (k, 3))
    elif kind == "inside":
        cloud[:k] = points(*wall(arc, k, seed=seed + 3), RADIUS * (1.0 - rng.uniform(0.0, 0.3, k)))
    else:
        flat = [rng.uniform(-0.5, 0.9, k) * RADIUS, rng.uniform(-1.0, 1.0, k) * RADIUS, np.full(k, LENGTH / 2)]
        cloud[:k] = TURN.apply(np.column_stack(flat)) + SHIFT
    return cloud


def misfit(fit, turn=TURN, shift=SHIFT):
    """Angle [rad] of the fitted axis to the true one, and its distance from the true middle [m]."""
    assert np.linalg.norm(fit.axis) == 1.0 or abs(np.linalg.norm(fit.axis) - 1.0) < 1e-12
    angle = np.linalg.norm(np.cross(fit.axis, turn.apply([0.0, 0.0, 1.0])))
    return angle, np.linalg.norm(np.cross(shift - fit.point, fit.axis))


def rough(arc, seed, length=5e-3, size=1e-4, waves=40):
    """A wall with a smooth random roughness of that correlation length [m] and standard deviation [m]."""
    rng = np.random.default_rng(seed)
    angle, height = wall(arc, 1500, seed=seed)
    number, phase = rng.normal(size=(waves, 2)) / length, rng.uniform(0.0, 2.0 * np.pi, waves)
    along = np.outer(angle * RADIUS, number[:, 0]) + np.outer(height, number[:, 1]) + phase
    return points(angle, height, RADIUS + size * np.sqrt(2.0 / waves) * np.cos(along).sum(axis=1))


CLOUDS = {
    "independent noise and outliers": lambda seed: spoilt(120, 1200, seed, "anywhere"),
    "few points": lambda seed: spoilt(120, 200, seed, "anywhere"),
    "errors that neighbours share": lambda seed: rough(120, seed),
}
