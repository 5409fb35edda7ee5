"""Thickness between two surfaces: spheres in closed form, a wedge, windings, what has none."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.geometry.surface import Surface
from geocontact.geometry.thickness import ThicknessMap, thickness_map
from meshes.simple_shapes import block, sphere

MM = 1e-3
R, SMALL = 20.0 * MM, 17.0 * MM


def ball(radius: float, at: tuple[float, float, float] = (0.0, 0.0, 0.0), n: int = 30) -> Surface:
    """A closed sphere of this radius [m] about a centre [m]."""
    vertices, faces = sphere(1.0, n)
    return Surface(radius * vertices + np.asarray(at), faces, f"ball {radius / MM:g}")


def mapped(outer: Surface, inner: Surface, most: float = 25.0 * MM, faces: np.ndarray | None = None) -> ThicknessMap:
    return thickness_map(outer, inner, most, faces)


def test_concentric_spheres_are_as_thick_as_their_radii_differ() -> None:
    found = mapped(ball(R), ball(SMALL))
    sag = 0.05 * MM  # of the facets of both
    np.testing.assert_allclose(found.along, R - SMALL, atol=sag)
    np.testing.assert_allclose(found.nearest, R - SMALL, atol=sag)
    mean, sd = found.mean_sd(found.along)
    assert mean == pytest.approx(R - SMALL, abs=sag) and sd < sag
    assert found.covered == 1.0 and not found.inside.any() and not found.outwards
    assert found.volume == pytest.approx(4.0 * np.pi * R**2 * (R - SMALL), rel=0.02)


def test_eccentric_spheres_tell_both_measures_apart() -> None:
    """Along the normal: the line from x through the outer centre meets the inner sphere; nearest: |x - c| - r."""
    centre, small = np.array([8.0, 0.0, 0.0]) * MM, 10.0 * MM
    found = mapped(ball(R), ball(small, tuple(centre)))
    way = -found.point / np.linalg.norm(found.point, axis=1)[:, None]
    start = R * -way
    offset = start - centre
    half = np.einsum("ni,ni->n", way, offset)
    along = -half - np.sqrt(half**2 - np.einsum("ni,ni->n", offset, offset) + small**2)
    nearest = np.linalg.norm(offset, axis=1) - small
    np.testing.assert_allclose(found.along, along, atol=0.08 * MM)
    np.testing.assert_allclose(found.nearest, nearest, atol=0.06 * MM)
    assert (found.along >= found.nearest - 1e-9).all()
    assert (along - nearest).max() > 2.0 * MM
    assert found.nearest.min() == pytest.approx(2.0 * MM, abs=0.06 * MM)
    assert found.nearest.max() == pytest.approx(18.0 * MM, abs=0.06 * MM)


def wedge(tilt: float) -> tuple[Surface, Surface]:
    """A square at y = 5 mm, and one below that is tilted about z [rad] through the origin."""
    corners = np.array([[-5.0, 5.0, -5.0], [5.0, 5.0, -5.0], [5.0, 5.0, 5.0], [-5.0, 5.0, 5.0]]) * MM
    faces = np.array([[0, 2, 1], [0, 3, 2]])  # normals along y
    below = np.array([[-50.0, 0.0, -50.0], [50.0, 0.0, -50.0], [50.0, 0.0, 50.0], [-50.0, 0.0, 50.0]]) * MM
    return Surface(corners, faces, "top"), Surface(Rotation.from_rotvec([0.0, 0.0, tilt]).apply(below), faces, "base")


@pytest.mark.parametrize("turned", [False, True])
def test_a_wedge_differs_by_the_cosine_and_windings_do_not_matter(turned: bool) -> None:
    top, base = wedge(0.3)
    if turned:
        top, base = (Surface(each.vertices, each.faces[:, ::-1], each.name) for each in (top, base))
    found = mapped(top, base)
    height = 5.0 * MM - np.tan(0.3) * found.point[:, 0]
    np.testing.assert_allclose(found.along, height, rtol=1e-9)
    np.testing.assert_allclose(found.nearest, height * np.cos(0.3), rtol=1e-9)
    assert found.outwards == turned
    expected = np.average(height, weights=found.area)
    assert found.volume == pytest.approx(expected * 100.0 * MM**2, rel=1e-9)
    assert found.mean_sd(found.along)[0] == pytest.approx(expected, rel=1e-9)


def test_what_is_too_far_or_inside_has_no_thickness() -> None:
    far = mapped(ball(R), ball(SMALL), most=2.0 * MM)
    assert np.isnan(far.along).all() and np.isnan(far.nearest).all() and far.covered == 0.0 and far.volume == 0.0
    assert np.isnan(far.quantiles(far.along, np.array([0.5]))).all() and np.isnan(far.mean_sd(far.along)).all()
    crossing = mapped(ball(R), ball(SMALL, (8.0 * MM, 0.0, 0.0)))
    beyond = np.linalg.norm(crossing.point - [8.0 * MM, 0.0, 0.0], axis=1) < SMALL
    assert beyond.any() and (crossing.inside == beyond).mean() > 0.99
    assert np.isnan(crossing.along[crossing.inside]).all() and np.isnan(crossing.nearest[crossing.inside]).all()


def cap(radius: float, at: tuple[float, float, float], least: float, n: int = 40, turned: bool = False) -> Surface:
    """Faces of a sphere whose normals have at least this along y: an open patch [m]."""
    whole = ball(radius, at, n)
    faces = whole.faces[whole.face_normal[:, 1] > least]
    return Surface(whole.vertices, faces[:, ::-1] if turned else faces, "cap")


@pytest.mark.parametrize("turned", [False, True])
def test_an_open_surface_that_crosses_has_no_thickness_there(turned: bool) -> None:
    """Two caps, the inner one shifted sideways: beyond it are centroids farther in than its radius, by hand."""
    centre = np.array([6.0, 0.0, 0.0]) * MM
    found = mapped(cap(R, (0.0, 0.0, 0.0), 0.6), cap(18.0 * MM, tuple(centre), 0.2, turned=turned))
    beyond = np.linalg.norm(found.point - centre, axis=1) < 18.0 * MM
    assert 0.1 < beyond.mean() < 0.4 and (found.inside == beyond).mean() > 0.99
    assert np.isnan(found.along[found.inside]).all() and np.isnan(found.nearest[found.inside]).all()
    clear = mapped(cap(R, (0.0, 0.0, 0.0), 0.6), cap(SMALL, (0.0, 0.0, 0.0), 0.2, turned=turned))
    assert not clear.inside.any() and clear.covered == 1.0


def test_another_condyle_and_the_underside_of_a_layer_do_not_cross() -> None:
    """A thin layer on one of two open caps that face each other, then a closed slab just above an open square."""
    one, other = cap(R, (0.0, 0.0, 0.0), 0.0), ball(R, (0.0, 46.0 * MM, 0.0))
    facing = other.faces[other.face_normal[:, 1] < 0.0]
    both = Surface(np.vstack([one.vertices, other.vertices]), np.vstack([one.faces, facing + len(one.vertices)]), "two")
    upper = mapped(cap(R + 2.0 * MM, (0.0, 0.0, 0.0), 0.5), both, most=30.0 * MM)
    assert not upper.inside.any() and np.nanmax(upper.along) < 2.2 * MM
    slab = Surface(*_scaled(block(10.0, 10.0, 4.0, 4)), "slab")
    base = wedge(0.0)[1]
    floor = (0.0, slab.vertices[:, 1].min() - 0.1 * MM, 0.0)
    below = Surface(np.add(base.vertices, floor), base.faces, "base")
    assert not mapped(slab, below).inside.any()


def test_a_region_and_quantiles_weighted_with_area() -> None:
    top, base = wedge(0.2)
    found = mapped(top, base, faces=np.array([False, True]))
    assert found.face.tolist() == [1] and found.area.sum() == pytest.approx(50.0 * MM**2)
    with pytest.raises(ValueError, match="no face counts"):
        mapped(top, base, faces=np.array([False, False]))
    slab = Surface(*_scaled(block(10.0, 10.0, 4.0, 2)), "slab")
    both = mapped(slab, ball(1.0 * MM, (0.0, -2.0 * MM, 0.0), 10))
    values = np.where(both.point[:, 1] > -1.0 * MM, 1.0, 3.0)  # the top is less than half of the area
    share = both.area[values == 1.0].sum() / both.area.sum()
    low, high = both.quantiles(values, np.array([0.5 * share, 0.5 * (1.0 + share)]))
    assert (low, high) == (1.0, 3.0)


def _scaled(shape: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    return shape[0] * MM, shape[1]
