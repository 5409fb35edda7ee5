"""Closed, open or irregular: counted on bodies whose edges are known."""

import re

import numpy as np
import pytest

from geocontact.geometry.topology import signed_volume, topology
from meshes import simple_shapes as shapes
from tests.geometry.bodies import cube, joined


def soup(body):
    """Every face with its own three vertices, as an STL file has them."""
    vertices, faces = body
    return vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)


CLOSED = {
    "sphere": (shapes.sphere(1.0, 4), 4 * np.pi / 3, 0.05),
    "torus": (shapes.torus(3.0, 1.0, 24), 2 * np.pi**2 * 3, 0.03),
    "cube": (cube((4, 5, 6), 0.5), 1.0, 1e-14),
    "two cubes": (joined(cube((0, 0, 0), 0.5), cube((0.3, 0, 0), 0.5)), 2.0, 1e-14),
}


@pytest.mark.parametrize("name", CLOSED)
@pytest.mark.parametrize("as_soup", [False, True])
def test_closed_bodies_are_closed_and_enclose_their_volume(name, as_soup):
    body, volume, facets = CLOSED[name]
    vertices, faces = soup(body) if as_soup else body
    found = topology(vertices, faces)
    assert found.closed
    assert found.why_open == ""
    assert (2 * found.edges, found.duplicate_faces) == (3 * len(faces), 0)
    assert signed_volume(vertices, faces) == pytest.approx(volume, rel=facets)
    assert signed_volume(vertices + 1e3, faces[:, ::-1]) == pytest.approx(-volume, rel=facets + 1e-9)


def spoilt(change):
    vertices, faces = cube((0, 0, 0), 1.0)
    return topology(vertices, change(faces))


@pytest.mark.parametrize(
    ("change", "open_edges", "irregular", "doubled", "words"),
    [
        (lambda f: f[1:], 3, 0, 0, "3 open edges"),
        (lambda f: np.vstack([f, f[:1]]), 0, 3, 1, "3 edges shared by more than two faces or .*, 1 doubled faces"),
        (lambda f: np.vstack([f, f[:1, ::-1]]), 0, 3, 1, "1 doubled faces"),
        (lambda f: np.vstack([f, f]), 0, 18, 12, "12 doubled faces"),
        (lambda f: np.vstack([f[:1, ::-1], f[1:]]), 0, 3, 0, "3 edges shared by more than two faces or by two of one"),
    ],
    ids=["hole", "doubled", "doubled and turned", "all doubled", "turned over"],
)
def test_what_keeps_a_cube_from_being_closed(change, open_edges, irregular, doubled, words):
    found = spoilt(change)
    assert not found.closed
    assert (found.open_edges, found.irregular_edges, found.duplicate_faces) == (open_edges, irregular, doubled)
    assert re.search(words, found.why_open), found.why_open


def test_doubled_faces_alone_are_no_hole():
    """Left out, the cube is closed; not one with a hole, nor where the first of two is the one turned over."""
    doubled = {name: spoilt(change).closed_once for name, change in DOUBLED.items()}
    assert doubled == {"again": True, "turned": True, "all": True, "turned first": False, "and a hole": False}
    assert spoilt(lambda f: f).closed_once
    assert not spoilt(lambda f: f[1:]).closed_once


DOUBLED = {
    "again": lambda f: np.vstack([f, f[:1]]),
    "turned": lambda f: np.vstack([f, f[:1, ::-1]]),
    "all": lambda f: np.vstack([f, f]),
    "turned first": lambda f: np.vstack([f[:1, ::-1], f]),
    "and a hole": lambda f: np.vstack([f[1:], f[1:2]]),
}


def test_collapsed_faces_do_not_open_a_body():
    """A face with two equal corners has no third edge to share; by index or by place alike."""
    vertices, faces = cube((0, 0, 0), 1.0)
    twin = np.vstack([vertices, vertices[:1]])
    assert topology(vertices, np.vstack([faces, [[0, 0, 1]]])).closed
    assert topology(twin, np.vstack([faces, [[0, len(vertices), 1]]])).closed


def test_minus_zero_is_zero():
    vertices, faces = soup(cube((1.0, 1.0, 1.0), 1.0))
    minus = vertices.copy()
    minus[::2][minus[::2] == 0] = -0.0
    assert np.signbit(minus).any()
    assert topology(minus, faces).closed


def test_nearly_coincident_vertices_are_two():
    vertices, faces = soup(cube((0, 0, 0), 1.0))
    vertices[0, 0] += 1e-12
    assert not topology(vertices, faces).closed
