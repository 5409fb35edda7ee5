"""Directions to start from, and frames along them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def half_sphere(count: int) -> list[Float[np.ndarray, " 3"]]:
    """Nearly even directions on the half-sphere (Fibonacci lattice)."""
    z = (np.arange(count) + 0.5) / count
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    ring = np.sqrt(1.0 - z * z)
    return list(np.stack([ring * np.cos(turn), ring * np.sin(turn), z], axis=1))


def across(direction: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """Rows: two unit vectors across the direction, and the direction, a unit vector whose largest part is positive."""
    largest = direction[int(np.argmax(np.abs(direction)))]
    along = direction * (np.sign(largest) / np.linalg.norm(direction))
    u = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(along, u), along])
