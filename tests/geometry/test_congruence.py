"""Curvatures of triangle surfaces, and of two that face each other: spheres, a sphere in a socket, a torus."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.congruence import (
    CongruencePair,
    congruence_evolution,
    longer_radius,
    median_edges,
    relative_curvatures,
)
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.curvature import Curvatures, _tensors
from meshes import simple_shapes
from tests.geometry.bodies import joined, surface, turned

RADIUS = 4e-3


def tensor(normal: np.ndarray, first: np.ndarray, least: float, most: float) -> np.ndarray:
    """Curvature tensor with principal curvatures along `first` and across it."""
    second = np.cross(normal, first)
    return most * np.outer(first, first) + least * np.outer(second, second)


def test_a_sphere_is_curved_by_one_over_its_radius() -> None:
    ball = surface(simple_shapes.sphere(20.0, 12))
    found = np.linalg.eigvalsh(Curvatures(ball, RADIUS).tensors(np.arange(len(ball.vertices))))
    np.testing.assert_allclose(found[:, 0], 0.0, atol=1e-9)
    np.testing.assert_allclose(found[:, 1:], 50.0 * (1.0 + RADIUS**2 / (4.0 * 0.02**2)), rtol=3e-3)


def test_a_torus_is_a_saddle_inside() -> None:
    body = simple_shapes.torus(30.0, 10.0, 40)
    ring = np.hypot(body[0][:, 0], body[0][:, 2])
    found = np.linalg.eigvalsh(Curvatures(surface(body), 3e-3).tensors(np.arange(len(ring))))
    along = 1e3 * (ring - 30.0) / 10.0 / ring
    assert along.min() == pytest.approx(-50.0)
    exact = np.sort(np.column_stack([np.zeros(len(ring)), along, np.full(len(ring), 100.0)]), axis=1)
    np.testing.assert_allclose(found, exact, atol=3.6)


def test_a_graph_that_is_tilted_over_its_plane_has_the_same_curvature() -> None:
    """Derivatives of a ball of 20 mm over a plane that its normal leaves by 35 degrees."""
    u, v = 0.02 * np.sin(np.radians(35.0)) * np.array([0.6, 0.8])
    up = np.sqrt(0.02**2 - u**2 - v**2)
    d, e = -u / up, -v / up
    fit = np.array([[up, d, e, -(1.0 + d * d) / up, -d * e / up, -(1.0 + e * e) / up]])
    found = np.linalg.eigvalsh(_tensors(fit, turned(10.0, 80.0, 20.0).as_matrix()[None]))
    np.testing.assert_allclose(found, [[0.0, 50.0, 50.0]], atol=1e-9)


def test_where_neighbours_are_few_there_is_no_curvature_and_none_across_an_edge() -> None:
    ball = surface(simple_shapes.sphere(20.0, 12))
    assert np.isnan(Curvatures(ball, 1e-3).tensors(np.arange(9))).all()
    slab = surface(simple_shapes.block(40.0, 40.0, 2.0, 20))
    middle = np.flatnonzero((np.abs(slab.vertices[:, [0, 2]]) < 6e-3).all(axis=1))
    np.testing.assert_allclose(Curvatures(slab, RADIUS).tensors(middle), 0.0, atol=1e-6)  # not the other face


def test_relative_curvatures_are_those_of_ateshian() -> None:
    """Mean curvatures, differences and the angle between principal directions, as the paper writes them."""
    rng = np.random.default_rng(3)
    normal = rng.standard_normal(3)
    normal /= np.linalg.norm(normal)
    one = np.cross(normal, rng.standard_normal(3))
    one /= np.linalg.norm(one)
    for _ in range(5):
        (least1, most1), (least2, most2) = (np.sort(rng.normal(0.0, 60.0, 2)) for _ in range(2))
        angle = rng.uniform(0.0, np.pi)
        other = np.cos(angle) * one + np.sin(angle) * np.cross(normal, one)
        total = tensor(normal, one, least1, most1) + tensor(normal, other, least2, most2)
        d1, d2 = least1 - most1, least2 - most2
        half = 0.5 * np.sqrt(d1**2 + d2**2 + 2.0 * d1 * d2 * np.cos(2.0 * angle))
        middle = 0.5 * (least1 + most1 + least2 + most2)
        (found,) = relative_curvatures(total[None], normal[None])
        np.testing.assert_allclose(found, [middle - half, middle + half], atol=1e-9)


CUP = simple_shapes.cup(24.0, 5.0, 24)
PAIRS = {
    "two balls": (simple_shapes.sphere(15.0, 14), simple_shapes.sphere(20.0, 14), 35.2, 1 / 15 + 1 / 20),
    "a ball in a socket": (simple_shapes.sphere(20.0, 14), CUP, None, 1 / 20 - 1 / 24),
    "a ball in a socket of its size": (simple_shapes.sphere(24.0, 16), CUP, None, 0.0),
}


@pytest.mark.parametrize("name", PAIRS)
def test_congruence_of_balls_is_that_of_their_radii(name: str) -> None:
    """MOVING comes turned; the index is the relative curvature in every direction, and all of the area has it."""
    moving, fixed, away, expected = PAIRS[name]
    radius = float(np.linalg.norm(moving[0][0]))
    shift = (0.0, away, 0.0) if away else (0.0, -(24.0 - radius) + 0.1, 0.0)
    pair = CongruencePair(surface(moving), surface(fixed), Settings(thresholds=(0.4e-3, 1e-3)), RADIUS)
    found = pair.at(turned(20.0, 50.0, -30.0).as_matrix(), np.array(shift) * 1e-3)
    for each in (found.least, found.most, found.index):
        np.testing.assert_allclose(each * 1e-3, expected, atol=0.025 / radius)
    assert (found.share > 0.9).all()  # the socket's rim faces elsewhere


def test_nothing_near_has_no_congruence_and_what_looks_away_does_not_count() -> None:
    ball, plate = surface(simple_shapes.sphere(20.0, 10)), surface(simple_shapes.block(60.0, 60.0, 3.0, 30))
    pair = CongruencePair(ball, plate, Settings(thresholds=(1e-3, 4e-3)), RADIUS)
    far = pair.at(np.eye(3), np.array([0.0, 0.05, 0.0]))
    assert np.isnan([far.index, far.share]).all()
    near = pair.at(np.eye(3), np.array([0.0, 0.0205, 0.0]))  # the lower face is within 4 mm too, and looks away
    np.testing.assert_allclose(near.index * 1e-3, 1 / 20, rtol=0.03)
    assert near.share[0] == 1.0 and 0.5 < near.share[1] < 1.0


def test_only_counted_faces_count() -> None:
    """FIXED has a smaller ball beside the first, as near, whose faces are left out."""
    big, small = simple_shapes.sphere(20.0, 12), simple_shapes.sphere(10.0, 10)
    fixed = surface(joined(big, (small[0] + [0.0, 31.0, 0.0], small[1])))
    ball = surface((simple_shapes.sphere(20.0, 12)[0] + [32.5, 24.5, 0.0], simple_shapes.sphere(20.0, 12)[1]))
    faces = np.arange(len(fixed.faces)) < len(big[1])
    settings = Settings(thresholds=(6e-3,), fixed_faces=faces)
    found = CongruencePair(ball, fixed, settings, RADIUS).at(np.eye(3), np.zeros(3))
    assert found.index[0] * 1e-3 == pytest.approx(1 / 20 + 1 / 20, rel=0.03)


def test_overlap_counts_however_deep_and_whatever_else_is_asked_for() -> None:
    """Balls that overlap by 6 mm: the figures within 0.5 mm are those with 8 mm beside it."""
    ball = surface(simple_shapes.sphere(20.0, 12))
    shift = np.array([0.0, 0.034, 0.0])
    alone, beside = (
        CongruencePair(ball, ball, Settings(thresholds=asked), RADIUS).at(np.eye(3), shift)
        for asked in ((0.5e-3,), (0.5e-3, 8e-3))
    )
    assert alone.index[0] * 1e-3 == pytest.approx(1 / 20 + 1 / 20, rel=0.03)
    for part in ("least", "most", "index", "share"):
        np.testing.assert_allclose(getattr(alone, part)[0], getattr(beside, part)[0], rtol=1e-9)


def apart(*heights: float) -> Motion:
    """Frames with MOVING's origin at these heights [mm]."""
    shift = np.column_stack([np.zeros(len(heights)), np.array(heights) * 1e-3, np.zeros(len(heights))])
    return Motion(0.1 * np.arange(len(heights)), RigidTransform.from_translation(shift))


def test_over_a_motion_two_balls_stay_as_congruent_as_they_are_until_they_part() -> None:
    one, other = surface(simple_shapes.sphere(15.0, 14)), surface(simple_shapes.sphere(20.0, 14))
    settings, steps = Settings(thresholds=(0.4e-3, 1e-3)), []
    found = congruence_evolution(one, other, apart(35.2, 34.9, 60.0), settings, RADIUS, lambda: steps.append(1))
    assert len(steps) == 3 and found.index.shape == (3, 2)
    np.testing.assert_allclose(found.index[:2] * 1e-3, 1 / 15 + 1 / 20, atol=0.025 / 15)
    assert np.isnan(found.index[2]).all() and np.isnan(found.share[2]).all()
    columns = found.columns()
    np.testing.assert_array_equal(columns["congruence_index [1/mm]"], found.index.ravel() * 1e-3)
    assert np.isnan(found.above(1.1).index).all() and (found.above(1.1).share[:2] == found.share[:2]).all()


def test_a_radius_shorter_than_the_edges_has_a_longer_one() -> None:
    """Between its vertices nothing lies within half an edge: two and a half edges of the coarser ball do."""
    one, other = surface(simple_shapes.sphere(15.0, 14)), surface(simple_shapes.sphere(20.0, 10))
    settings, motion = Settings(thresholds=(1e-3,)), apart(35.2)
    short = 0.5 * min(median_edges(one, other))
    found = congruence_evolution(one, other, motion, settings, short)
    assert found.share[0, 0] == 0.0
    longer = longer_radius(one, other, motion, settings, short, found)
    assert longer == pytest.approx(2.5 * float(np.median(other.edge_length)), abs=1e-4)
    again = congruence_evolution(one, other, motion, settings, longer)
    assert again.share[0, 0] > 0.5
    assert longer_radius(one, other, motion, settings, 1.0, found) is None
