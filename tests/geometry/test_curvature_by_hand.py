"""Curvature of a vertex beside a fit in loops and the shape operator I⁻¹ II of what it fits."""

from __future__ import annotations

from math import sqrt

import numpy as np

from geocontact.geometry.curvature import SAME_SIDE, Curvatures
from geocontact.geometry.surface import Surface
from meshes import simple_shapes
from tests.geometry.bodies import surface

RADIUS = 5e-3


def dented() -> Surface:
    """A ball of 20 mm, squashed and waved so that no vertex is like another."""
    places, faces = simple_shapes.sphere(20.0, 10)
    waved = places * [1.0, 0.8, 1.3] + 0.4 * np.sin(0.31 * places[:, [1, 2, 0]])
    return surface((waved, faces))


def normals_by_hand(body: Surface) -> np.ndarray:
    """Sum of the half cross products of the faces around each vertex, over its length."""
    total = np.zeros((len(body.vertices), 3))
    for a, b, c in body.faces:
        p, q, r = body.vertices[[a, b, c]]
        for corner in (a, b, c):
            total[corner] += 0.5 * np.cross(q - p, r - p)
    return np.array([each / sqrt(each @ each) for each in total])


def principal_by_hand(body: Surface, vertex: int, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Principal curvatures, the lesser first, and their directions in space; convex positive."""
    up = normals[vertex]
    first = np.cross(up, [0.3, -0.5, 0.81])
    first /= sqrt(first @ first)
    second = np.cross(up, first)
    rows, heights = [], []
    for other, place in enumerate(body.vertices):
        away = place - body.vertices[vertex]
        if sqrt(away @ away) <= RADIUS and normals[other] @ up > SAME_SIDE:
            u, v = away @ first, away @ second
            rows.append([1.0, u, v, u * u, u * v, v * v])
            heights.append(away @ up)
    _, d, e, a, b, c = np.linalg.lstsq(np.array(rows), np.array(heights), rcond=None)[0]
    metric = np.array([[1.0 + d * d, d * e], [d * e, 1.0 + e * e]])
    form = np.array([[2.0 * a, b], [b, 2.0 * c]]) / sqrt(1.0 + d * d + e * e)
    values, vectors = np.linalg.eig(-np.linalg.inv(metric) @ form)
    ways = [w[0] * (first + d * up) + w[1] * (second + e * up) for w in vectors.T]
    order = np.argsort(values.real)
    return values.real[order], np.array([ways[k] / sqrt(ways[k] @ ways[k]) for k in order])


def test_a_vertex_by_hand() -> None:
    body = dented()
    normals, asked = normals_by_hand(body), np.array([0, 7, 31, 58, 90])
    curved = Curvatures(body, RADIUS)
    np.testing.assert_allclose(curved.normals, normals, atol=1e-12)
    for vertex, found in zip(asked, curved.tensors(asked), strict=True):
        (least, most), ways = principal_by_hand(body, int(vertex), normals)
        assert most - least > 1.0, "the two are told apart"
        by_hand = least * np.outer(ways[0], ways[0]) + most * np.outer(ways[1], ways[1])
        np.testing.assert_allclose(found, by_hand, atol=1e-6 * abs(most))
