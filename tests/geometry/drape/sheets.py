"""Surfaces to lay mats on, in metres: plane, prism of a tube, cone, sphere, and a thigh-like doubly curved one."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.drape.spread import Geodesics
from geocontact.geometry.surface import Surface
from meshes import simple_shapes


def plane(size=0.5, n=23, seed=0):
    """Square in z = 0, seen from +z, its inner vertices shaken."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, n + 1), np.linspace(-0.5, 0.5, n + 1), indexing="ij")
    shake = np.random.default_rng(seed).uniform(-0.3, 0.3, (2, n + 1, n + 1)) / n
    shake[:, [0, -1]] = 0
    shake[:, :, [0, -1]] = 0
    vertices = np.column_stack([(x + shake[0]).ravel(), (y + shake[1]).ravel(), np.zeros(x.size)]) * size
    return vertices, lattice_faces(n + 1, n + 1)


def lattice_faces(a, b):
    """Triangles of a grid of a x b vertices, counter-clockwise where the first axis x second axis is the normal."""
    index = np.arange(a * b).reshape(a, b)
    p, q, r, s = (index[i, j].ravel() for i, j in CORNERS)
    return np.vstack([np.column_stack([p, q, r]), np.column_stack([p, r, s])])


CORNERS = [
    (slice(None, -1), slice(None, -1)),
    (slice(1, None), slice(None, -1)),
    (slice(1, None), slice(1, None)),
    (slice(None, -1), slice(1, None)),
]


def of_revolution(radius, height, around, along):
    """Open tube about z: `radius` as a function of z; vertices on the smooth surface, normals outside."""
    turn = 2 * np.pi * np.arange(around) / around
    z = np.linspace(0.0, height, along + 1)
    r = radius(z)
    vertices = np.stack(
        [r * np.cos(turn)[:, None], r * np.sin(turn)[:, None], np.broadcast_to(z, (around, along + 1))], axis=-1
    ).reshape(-1, 3)
    index = np.arange(around * (along + 1)).reshape(around, along + 1)
    after = np.roll(index, -1, axis=0)
    p, q, s, t = index[:, :-1].ravel(), after[:, :-1].ravel(), after[:, 1:].ravel(), index[:, 1:].ravel()
    return vertices, np.vstack([np.column_stack([p, q, s]), np.column_stack([p, s, t])])


def tube(radius=0.06, height=0.5, n=60):
    return of_revolution(lambda z: radius + 0.0 * z, height, n, n)


def cone(n=60, slope=0.2):
    return of_revolution(lambda z: 0.05 + slope * z, 0.4, n, n)


def thigh(n=80):
    """Barrel: 78 mm at its fullest, 55 mm at the knee; curved both ways."""
    return of_revolution(lambda z: 0.078 - 0.023 * ((z - 0.28) / 0.28) ** 2, 0.42, n, n)


def sphere(radius=0.12, n=40):
    vertices, faces = simple_shapes.sphere(1e3 * radius, n)
    return vertices * 1e-3, faces


def over(body, name="body"):
    return Geodesics(Surface(*body, name))
