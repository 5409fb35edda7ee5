"""Points spread evenly over a surface, the same ones every time."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.surface import Surface

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
