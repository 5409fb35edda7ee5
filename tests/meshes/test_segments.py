"""The smooth body segments: derivatives, closed-form limits, balance of the closed skin, and what the meshes lose."""

import numpy as np
import pytest
from scipy.special import gamma

from meshes.segment_areas import girth, section_area, size
from meshes.segment_meshes import RINGS, segment_mesh
from meshes.segments import SEGMENTS, SHANK, THIGH, TORSO, UPPER_ARM, Oval, Segment
from meshes.solids import area, volume
from meshes.stl import GRID_MM

each_segment = pytest.mark.parametrize("segment", SEGMENTS, ids=lambda s: s.name)


def spread(segment, n=200):
    """Parameters all over the skin."""
    k = np.arange(n) + 0.5
    return np.column_stack([2 * np.pi * (k * 0.7548776662 % 1), segment.length * (k * 0.5698402910 % 1 - 0.5)])


@each_segment
def test_derivatives_are_those_of_the_points(segment):
    at, step = spread(segment), 1e-30  # complex step: no difference is taken, nothing cancels
    exact = segment.derivatives(at)
    for k in range(2):
        aside = at + 1j * step * np.eye(2)[k]
        assert segment.points(aside).imag / step == pytest.approx(exact[:, k], abs=1e-11)
        second = segment.derivatives(aside)[:, :2].imag / step
        assert second == pytest.approx(exact[:, [2 + k, 3 + k]], abs=1e-11)


def test_cone_has_the_area_and_volume_of_the_textbook():
    cone = Segment("cone", 300.0, Oval(60.0, 60.0), 0.001, 0.0)
    low, high = 60.0 * 0.85, 60.0 * 1.15
    found = size(cone)
    assert found.skin == pytest.approx(np.pi * (low + high) * np.hypot(300.0, high - low), rel=1e-13)
    assert found.ends == pytest.approx(np.pi * (low**2 + high**2), rel=1e-13)
    assert found.volume == pytest.approx(np.pi * 300.0 / 3 * (low**2 + low * high + high**2), rel=1e-13)


@pytest.mark.parametrize(("roundness", "factor"), [(1.0, np.pi), (0.0, 4 * gamma(1.25) ** 2 / gamma(1.5))])
def test_ovals_are_ellipse_and_super_ellipse(roundness, factor):
    straight = Segment("tube", 100.0, Oval(40.0, 70.0, roundness), 0.0, 0.0)
    assert section_area(straight, 10.0) == pytest.approx(factor * 40.0 * 70.0, rel=1e-13)
    assert straight.points(np.array([[0.0, 1.0], [np.pi / 2, 1.0]])) == pytest.approx(
        np.array([[40.0, 1.0, 0.0], [0.0, 1.0, 70.0]])
    )


@each_segment
def test_closed_skin_has_no_net_area_vector(segment):
    """Integral of n over skin and ends vanishes: uniform pressure does not push a body anywhere."""
    nodes, weights = np.polynomial.legendre.leggauss(96)
    theta = 2 * np.pi * np.arange(512) / 512
    at = np.stack(np.meshgrid(theta, segment.length / 2 * nodes, indexing="ij"), axis=-1)
    skin = np.einsum("tyx,y->x", segment.area_vector(at), 2 * np.pi / 512 * segment.length / 2 * weights)
    ends = section_area(segment, segment.length / 2) - section_area(segment, -segment.length / 2)
    assert skin + np.array([0, ends, 0]) == pytest.approx(np.zeros(3), abs=1e-12 * size(segment).skin)
    assert (np.einsum("tyx,tyx->ty", segment.area_vector(at), segment.points(at) * [1, 0, 1]) > 0).all(), "outwards"


@each_segment
def test_quadratures_do_not_depend_on_their_nodes(segment):
    coarse, fine = size(segment, 128, 40), size(segment)
    assert (coarse.skin, coarse.volume) == pytest.approx((fine.skin, fine.volume), rel=1e-12)


@each_segment
def test_mesh_loses_area_and_volume_at_second_order(segment):
    cells, smooth = np.array([6, 12, 24]), size(segment)
    bodies = [segment_mesh(segment, n) for n in cells]
    for errors in (
        [smooth.skin + smooth.ends - area(*body) for body in bodies],
        [smooth.volume - volume(*body) for body in bodies],
    ):
        order = -np.polyfit(np.log(cells), np.log(errors), 1)[0]
        assert order == pytest.approx(2.0, abs=0.1), f"observed order {order:.2f}, errors {errors}"
    assert area(*segment_mesh(segment, RINGS[segment])) == pytest.approx(smooth.skin + smooth.ends, rel=1.1e-3)


@each_segment
def test_vertices_lie_on_the_skin_or_in_the_ends(segment):
    vertices, _ = segment_mesh(segment, RINGS[segment])
    inside = np.abs(vertices[:, 1]) < segment.length / 2
    off = segment.off_surface(vertices)
    assert np.abs(off[inside]).max() < GRID_MM
    assert off[~inside].max() < GRID_MM
    assert inside.sum() > 1000


def test_girths_are_those_that_are_stated():
    assert girth(THIGH, 0.0) == pytest.approx(490, abs=5)
    assert girth(SHANK, 85.0) == pytest.approx(340, abs=5)
    assert girth(UPPER_ARM, 0.0) == pytest.approx(300, abs=5)
    assert girth(TORSO, 105.0) == pytest.approx(890, abs=5)
