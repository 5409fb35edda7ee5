"""Parametric tibial insert of a total knee (synthetic; right side; mm).

Frame T: x anterior, y superior, z right (lateral); the origin lies in the underside, midway between the dishes.
The upper face has two dishes, each the sum of a sagittal and a coronal circular arc, levelled off by a rim of limited
height around them and an eminence between them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.sheets import hexagonal_disc
from meshes.solids import thicken

HALF_DEPTH, HALF_WIDTH = 25.0, 37.5
"""Half size of the outline along x and z [mm]."""
SULCUS, RIM, EMINENCE = 6.8, 11.0, 12.5
"""Height above the underside of the lowest points, of the rim and of the eminence at most [mm]."""


@dataclass(frozen=True)
class Dish:
    """Centre of a dish (x, z) and its sagittal and coronal radii [mm]."""

    x: float
    z: float
    sagittal: float
    coronal: float


MEDIAL = Dish(-2.0, -23.0, 48.0, 27.5)
LATERAL = Dish(-2.0, 23.0, 58.0, 29.0)


def dish_height(dish: Dish, x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Height [mm] of an unbounded dish: two circular arcs added."""
    sagittal = dish.sagittal - np.sqrt(dish.sagittal**2 - (x - dish.x) ** 2)
    across = np.clip(z - dish.z, -0.98 * dish.coronal, 0.98 * dish.coronal)
    return SULCUS + sagittal + dish.coronal - np.sqrt(dish.coronal**2 - across**2)


def smaller(a: np.ndarray, b: np.ndarray, width: float) -> np.ndarray:
    """Minimum of a and b, rounded where they differ by less than `width` (once continuously differentiable)."""
    overlap = np.clip(width - np.abs(a - b), 0, None)
    return np.minimum(a, b) - overlap**2 / (4 * width)


def upper_height(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Height of the articular face [mm]."""
    dishes = smaller(dish_height(MEDIAL, x, z), dish_height(LATERAL, x, z), 3.0)
    # The cap is low around the border and higher between the dishes; it slopes down towards the back.
    middle = np.exp(-((z / 9.0) ** 2) - ((x - 2.0) / 18.0) ** 4)
    cap = RIM - 0.03 * (HALF_DEPTH - x) + (EMINENCE - RIM) * middle
    return smaller(dishes, cap, 2.0)


def border(angle: np.ndarray) -> np.ndarray:
    """Border points (n, 2) = (x, z) [mm]: an ellipse of exponent 2.6 with a notch for the ligament behind."""
    c, s = np.cos(angle), np.sin(angle)
    full = (np.abs(c) ** 2.6 + np.abs(s) ** 2.6) ** (-1 / 2.6)
    # `angle` counts from the front, so the notch sits at angle = pi.
    dent = 1 - 0.20 * np.exp(-(((angle - np.pi) / 0.32) ** 2))
    return np.column_stack([HALF_DEPTH * c, HALF_WIDTH * s]) * (full * dent)[:, None]


def outline(fraction: np.ndarray) -> np.ndarray:
    """Border points at a fraction 0..1 of the way around, evenly spaced by length."""
    angle = np.linspace(0, 2 * np.pi, 20001)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(border(angle), axis=0), axis=1))])
    return border(np.interp(fraction * length[-1], length, angle))


def tibial_insert(rings: int, wall: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [mm, frame T] and faces of the closed right insert: 12 rings^2 + 12 rings wall faces."""
    radius, turn, faces = hexagonal_disc(rings)
    plan = radius[:, None] * outline(turn)
    upper = np.column_stack([plan[:, 0], upper_height(*plan.T), plan[:, 1]])
    under = np.column_stack([0.96 * plan[:, 0], np.zeros(len(plan)), 0.96 * plan[:, 1]])
    return thicken(upper, under, faces[:, ::-1], wall)
