"""Pieces of a surface: areas and centroids are kept, whatever the edge, and every piece is in its face."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import MOST, surface_quadrature
from tests.geometry.bodies import MM, cube, joined, surface

BLOCK = cube((1.0, 2.0, 3.0), (4.0, 0.7, 9.0))


@pytest.mark.parametrize("edge", [np.inf, 5e-3, 1e-3, 0.3e-3])
def test_area_and_first_moment_are_kept(edge: float) -> None:
    body = surface(BLOCK)
    pieces = surface_quadrature(body, edge)
    assert pieces.area.sum() == pytest.approx(body.face_area.sum(), rel=1e-12)
    middles = body.vertices[body.faces].mean(axis=1)
    np.testing.assert_allclose(pieces.area @ pieces.point, body.face_area @ middles, rtol=1e-12)
    flux = np.einsum("p,pi,pi->", pieces.area, pieces.normal, pieces.point)
    assert flux / 3.0 == pytest.approx(8.0 * 4.0 * 0.7 * 9.0 * MM**3, rel=1e-9), "volume, by Gauss"


def test_every_piece_lies_in_its_face_and_is_small() -> None:
    body = surface(BLOCK)
    pieces = surface_quadrature(body, 1e-3)
    a, b, c = np.moveaxis(body.vertices[body.faces[pieces.face]], 1, 0)
    height = np.einsum("pi,pi->p", pieces.point - a, pieces.normal)
    np.testing.assert_allclose(height, 0.0, atol=1e-15)
    for p, q in ((a, b), (b, c), (c, a)):
        assert (np.einsum("pi,pi->p", np.cross(q - p, pieces.point - p), pieces.normal) > 0.0).all()
    assert pieces.area.max() <= 0.5e-6
    assert len(np.unique(np.round(pieces.point, 9), axis=0)) == len(pieces.point)


def test_means_over_faces() -> None:
    body = surface(BLOCK)
    pieces = surface_quadrature(body, 1e-3)
    middles = body.vertices[body.faces].mean(axis=1)
    np.testing.assert_allclose(pieces.face_means(pieces.point[:, 2], len(body.faces)), middles[:, 2], atol=1e-12)


def test_only_faces_that_count_and_each_once() -> None:
    twice = joined(BLOCK, BLOCK)
    flat = np.vstack([twice[1], [[0, 0, 1]]])
    body = Surface(twice[0] * MM, flat)
    whole = surface(BLOCK)
    assert surface_quadrature(body).area.sum() == pytest.approx(whole.face_area.sum(), rel=1e-12)
    up = whole.face_normal[:, 1] > 0.5
    top = surface_quadrature(whole, 1e-3, up)
    assert top.area.sum() == pytest.approx(8.0 * 18.0 * MM**2, rel=1e-12) and (top.normal[:, 1] == 1.0).all()
    assert len(surface_quadrature(whole, 1e-3, np.zeros(len(whole.faces), bool)).area) == 0


def test_a_slip_in_the_unit_is_refused() -> None:
    with pytest.raises(ValueError, match="pieces, more than"):
        surface_quadrature(surface(BLOCK), 1e-6)
    assert MOST == 4_000_000
