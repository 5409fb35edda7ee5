"""Closed bodies with closed-form contact areas, at any resolution: vertices (n, 3) and faces (m, 3), faces outwards.

Lengths come back in the unit they are given in (the shipped files use mm). y is up; curved bodies are centred at the
origin; the top of the block is the plane y = 0. Vertices lie on the smooth shape, so that a curved surface loses area
and volume in proportion to the square of the edge length.
"""

from __future__ import annotations

import numpy as np

from meshes.sheets import hexagonal_disc, quads_of, split_quads
from meshes.solids import thicken

GOLDEN = (1 + 5**0.5) / 2
ICOSAHEDRON = np.array([[0, a, b * GOLDEN] for a in (-1, 1) for b in (-1, 1)])
ICOSAHEDRON = np.vstack([np.roll(ICOSAHEDRON, k, axis=1) for k in range(3)])


def icosahedron_faces() -> np.ndarray:
    """The 20 triples of mutually neighbouring corners, turned outwards."""
    near = np.linalg.norm(ICOSAHEDRON[:, None] - ICOSAHEDRON[None], axis=-1) < 2.1
    triples = [
        (i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]
    ]
    faces = np.array(triples)
    turned = np.linalg.det(ICOSAHEDRON[faces]) < 0
    faces[turned] = faces[turned, ::-1]
    return faces


def sphere(radius: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Sphere of 20 n^2 faces: every face of an icosahedron cut into n^2, then moved out to the radius."""
    corners = ICOSAHEDRON[icosahedron_faces()]
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    i, j = i[i + j <= n], j[i + j <= n]
    weights = np.column_stack([n - i - j, i, j]) / n
    number = np.full((n + 2, n + 2), -1)
    number[i, j] = np.arange(len(i))
    up = np.column_stack([number[i, j], number[i + 1, j], number[i, j + 1]])
    down = np.column_stack([number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]])
    cell = np.vstack([up[i + j < n], down[i + j < n - 1]])
    points = np.einsum("wc,fcx->fwx", weights, corners)
    points *= radius / np.linalg.norm(points, axis=-1, keepdims=True)
    faces = (cell[None] + len(weights) * np.arange(20)[:, None, None]).reshape(-1, 3)
    return merged(points.reshape(-1, 3), faces, 1e-6 * radius)


def merged(vertices: np.ndarray, faces: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """One vertex for those that agree to within `tolerance`, faces renumbered in their order."""
    _, first, inverse = np.unique(np.round(vertices / tolerance), axis=0, return_index=True, return_inverse=True)
    return vertices[first], inverse.ravel()[faces]


def block(width: float, depth: float, height: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Box with its top in y = 0, centred on the y axis: `width` along x, `depth` along z, n cells along x on top."""
    along_z, layers = max(1, round(n * depth / width)), max(1, round(n * height / width))
    x, z = np.meshgrid(
        np.linspace(-0.5, 0.5, n + 1) * width, np.linspace(-0.5, 0.5, along_z + 1) * depth, indexing="ij"
    )
    top = np.column_stack([x.ravel(), np.zeros(x.size), z.ravel()])
    faces = split_quads(top, quads_of(np.arange(x.size).reshape(x.shape)))
    return thicken(top, top - [0, height, 0], faces, layers)


def cylinder(radius: float, length: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Closed cylinder about the z axis, 6 n cells around."""
    distance, turn, faces = hexagonal_disc(n)
    x, y = distance * radius * np.cos(2 * np.pi * turn), distance * radius * np.sin(2 * np.pi * turn)
    cap = np.column_stack([x, y, np.full(len(x), length / 2)])
    layers = max(1, round(length / (2 * np.pi * radius / (6 * n))))
    return thicken(cap, cap - [0, 0, length], faces, layers)


def cup(radius: float, thickness: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Hemispherical cup that opens upwards: cavity of `radius` about the origin, wall of `thickness`.

    12 n^2 faces and those of the rim.
    """
    distance, turn, faces = hexagonal_disc(n)
    polar, around = distance * np.pi / 2, 2 * np.pi * turn
    downwards = np.column_stack([np.sin(polar) * np.cos(around), -np.cos(polar), np.sin(polar) * np.sin(around)])
    layers = max(1, round(thickness / (np.pi / 2 * radius / n)))
    return thicken((radius + thickness) * downwards, radius * downwards, faces, layers)


def torus(ring: float, tube: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Torus around the y axis: core circle of radius `ring`, tube of radius `tube`, n cells around the tube."""
    around = max(3, round(n * ring / tube))
    theta, phi = np.meshgrid(2 * np.pi * np.arange(around) / around, 2 * np.pi * np.arange(n) / n, indexing="ij")
    out = ring + tube * np.cos(phi)
    vertices = np.stack([out * np.cos(theta), tube * np.sin(phi), out * np.sin(theta)], axis=-1).reshape(-1, 3)
    index = np.arange(around * n).reshape(around, n)
    right, above = np.roll(index, -1, axis=0), np.roll(index, -1, axis=1)
    quads = np.stack([index, above, np.roll(right, -1, axis=1), right], axis=-1).reshape(-1, 4)
    return vertices, split_quads(vertices, quads)


SAMPLES = {
    "sphere_r20": (sphere, (20.0,), 12),
    "sphere_r18": (sphere, (18.0,), 12),
    "plate_80x80x12": (block, (80.0, 80.0, 12.0), 24),
    "cylinder_r15_l40": (cylinder, (15.0, 40.0), 10),
    "cup_r24": (cup, (24.0, 5.0), 14),
    "torus_r25_r8": (torus, (25.0, 8.0), 24),
}
"""The shipped shapes: function, lengths [mm] and number of cells n; pass a larger n for a finer mesh."""
