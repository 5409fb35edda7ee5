"""Radius over flexion: torus and synthetic femoral component, whose radii are known; ellipse, order of the window."""

import numpy as np
import pytest

from geocontact.geometry.fit.profile import sagittal_profile
from geocontact.geometry.plane import Plane
from geocontact.geometry.regions import about, faces_where
from geocontact.geometry.sagittal import Sagittal
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import Axis
from meshes.femoral_component import DISTAL, POSTERIOR, Grid, femoral_component
from meshes.simple_shapes import torus
from tests.geometry.bodies import MM, moved, surface, turned

Z = Axis((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
SIDE_VIEW = Sagittal(Z, (0.0, -1.0, 0.0), (-1.0, 0.0, 0.0))


def tube(a, b, n):
    """Wall of an elliptic cylinder along z: half-axes a in x and b in y [m]."""
    turn = 2.0 * np.pi * np.arange(n) / n
    ring = np.column_stack([a * np.cos(turn), b * np.sin(turn)])
    vertices = np.concatenate([np.column_stack([ring, np.full(n, z)]) for z in (-0.01, 0.01)])
    k = np.arange(n)
    after = (k + 1) % n
    return Surface(
        vertices, np.concatenate([np.column_stack([k, after, k + n]), np.column_stack([after, after + n, k + n])])
    )


def test_outline_of_a_torus_is_its_largest_circle_whichever_way_it_lies():
    """Sagittal radius 33, coronal 8: a cylinder through all of it would mix them. Facets cost 0.1 %."""
    turn, shift = turned(20, -35, 50), np.array([3.0, -2.0, 5.0])
    ring = surface(moved(torus(25.0, 8.0, 48), turn, shift), "ring")
    axis = Axis(tuple(shift * MM), tuple(turn.apply([0.0, 1.0, 0.0])))
    sagittal = Sagittal(axis, tuple(turn.apply([1.0, 0.2, 0.0])), tuple(turn.apply([0.3, 0.0, -1.0])))
    angle = np.radians([-120.0, -30.0, 0.0, 45.0, 170.0])
    p = sagittal_profile(ring, None, sagittal, angle, np.radians(30.0))
    np.testing.assert_allclose(p.radius, 0.033, rtol=2e-3)
    np.testing.assert_allclose(p.normal, angle, atol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(p.centre - shift * MM, axis=1), 0.0, atol=1e-4)
    np.testing.assert_allclose(sagittal.angle(p.crest), angle, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(p.crest - shift * MM, axis=1), 0.033, rtol=2e-3)


def test_synthetic_femoral_component_has_the_radii_it_was_made_with():
    vertices, faces = femoral_component(Grid().refined(2.0))
    body = Surface(np.asarray(vertices) * MM, np.ascontiguousarray(faces, np.int64))
    outer = faces_where(body, "outward > 0.5", MM, about(body, Z.point, Z.direction, MM))
    for side in (-1, 1):
        p = sagittal_profile(
            body, outer, SIDE_VIEW, np.radians([-30.0, 0.0, 30.0, 60.0, 90.0, 170.0]), np.radians(30.0),
            (Plane.across("z"), side),
        )  # fmt: skip
        np.testing.assert_allclose(p.radius[:2], DISTAL * MM, rtol=4e-3)
        assert POSTERIOR * MM < p.radius[2] < DISTAL * MM, "the window spans both arcs"
        np.testing.assert_allclose(p.radius[3:5], POSTERIOR * MM, rtol=4e-3)
        np.testing.assert_allclose(p.normal[3:5], p.angle[3:5], atol=1e-3)  # the axis is the centre of that arc
        assert np.isnan(p.radius[5]) and np.isnan(p.crest[5]).all()
        assert (side * p.crest[:5, 2] > 0.015).all()
        assert (np.abs(p.radius - np.array([34, 34, np.nan, 22, 22, np.nan]) * MM) < p.half_width)[[0, 1, 3, 4]].all()


def test_radius_of_an_ellipse_converges_with_the_square_of_the_window():
    """R = (a² sin² t + b² cos² t)^1.5 / (a b) at the parameter t of the place."""
    a, b = 0.04, 0.03
    body, angle = tube(a, b, 20_000), np.radians([-35.0, -5.0, 10.0, 65.0, 95.0])
    place = np.column_stack([-np.sin(angle), -np.cos(angle)])
    t = np.arctan2(place[:, 1] / b, place[:, 0] / a)
    exact = (a**2 * np.sin(t) ** 2 + b**2 * np.cos(t) ** 2) ** 1.5 / (a * b)
    windows = np.radians([10.0, 20.0, 40.0])
    error = np.array([np.abs(sagittal_profile(body, None, SIDE_VIEW, angle, w).radius - exact) for w in windows])
    order = np.polyfit(np.log(windows), np.log(np.sqrt((error**2).mean(axis=1))), 1)[0]
    assert order == pytest.approx(2.0, abs=0.2), (order, error)
    assert (error[0] < 5e-3 * exact).all()


def test_angles_are_those_of_the_directions_given():
    sagittal = Sagittal(Axis((0.01, 0.02, 0.0), (0.0, 0.0, -3.0)), (0.0, -1.0, 0.3), (1.0, 0.0, 0.0))
    places = np.array([[0.01, -1.0, 0.0], [1.01, 0.02, 5.0], [-0.99, 0.02, 0.0], [1.01, -0.98, 1.0]])
    np.testing.assert_allclose(np.degrees(sagittal.angle(places)), [0.0, 90.0, -90.0, 45.0], atol=1e-9)
    np.testing.assert_allclose(sagittal.placed(sagittal.local(places)), places, atol=1e-12)
    assert np.linalg.det(sagittal.frame) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("zero", "ninety", "words"),
    [
        ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), "along the axis"),
        ((0.0, 1.0, 0.0), (0.0, 0.0, -1.0), "along the axis"),
        ((0.0, 1.0, 0.0), (0.0, -1.0, 0.0), "are the same"),
    ],
)
def test_directions_that_say_nothing_are_refused(zero, ninety, words):
    with pytest.raises(ValueError, match=words):
        Sagittal(Z, zero, ninety)
