"""Outlines of shapes whose outline is known."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.sagittal import silhouette
from meshes.simple_shapes import block, sphere


def length(vertices: np.ndarray, edges: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(vertices[edges], axis=1), axis=-1).sum())


@pytest.mark.parametrize(("axis", "sides"), [(0, (12.0, 60.0)), (1, (80.0, 60.0)), (2, (80.0, 12.0))])
def test_a_block_shows_its_rectangle(axis: int, sides: tuple[float, float]) -> None:
    vertices, faces = block(80.0, 60.0, 12.0, 4)
    assert length(vertices, silhouette(vertices, faces, np.eye(3)[axis])) == pytest.approx(2.0 * sum(sides))


def test_a_sphere_shows_a_closed_line_about_a_great_circle() -> None:
    vertices, faces = sphere(20.0, 40)
    edges = silhouette(vertices, faces, np.array([0.6, 0.0, 0.8]))
    off = vertices[edges].reshape(-1, 3) @ [0.6, 0.0, 0.8]
    assert np.abs(off).max() < 2.0
    assert (np.bincount(edges.ravel()) % 2 == 0).all(), "closed"
    assert 0.98 < length(vertices, edges) / (2.0 * np.pi * 20.0) < np.sqrt(2.0), "along edges, so with corners"


def test_open_edges_belong_to_the_outline() -> None:
    vertices, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, -1]]), np.array([[0, 1, 2]])
    assert len(silhouette(vertices, faces, np.array([0.0, 1.0, 0.0]))) == 3
