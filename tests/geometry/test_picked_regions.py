"""Faces chosen by picked points, against half planes, distances and a winding number by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.picked_regions import even_odd, faces_near, faces_within
from geocontact.geometry.surface import Surface
from meshes.simple_shapes import block, sphere
from tests.geometry.bodies import MM, joined, moved, surface, turned

TURN, SHIFT = turned(20, -35, 50), np.array([130.0, -20.0, 51.0])
PLATE = block(40.0, 40.0, 2.0, 16)
"""Closed and thin: its top and bottom are 2 mm apart."""


def middles(body: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    return np.asarray(body[0][body[1]].mean(axis=1))


def top(body: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Faces whose corners are all at the greatest height of the axis that the plate is thin along."""
    thin = int(np.argmin(np.ptp(body[0], axis=0)))
    return np.asarray((body[0][body[1]][:, :, thin] > body[0][:, thin].max() - 1e-9).all(axis=1))


def flat_axes(body: tuple[np.ndarray, np.ndarray]) -> tuple[int, int]:
    thin = int(np.argmin(np.ptp(body[0], axis=0)))
    first, second = (axis for axis in range(3) if axis != thin)
    return first, second


def on_top(body: tuple[np.ndarray, np.ndarray], places: list[tuple[float, float]]) -> np.ndarray:
    first, second = flat_axes(body)
    points = np.tile(body[0].max(axis=0), (len(places), 1))
    points[:, first], points[:, second] = np.array(places).T + body[0].mean(axis=0)[[first, second], None]
    return points


@pytest.mark.parametrize("turned_round", [False, True])
@pytest.mark.parametrize("order", [1, -1])
def test_a_quadrilateral_holds_the_faces_inside_its_four_half_planes(turned_round: bool, order: int) -> None:
    places = [(-11.0, -9.3), (12.2, -7.0), (9.1, 13.3), (-8.0, 7.7)]
    corners = on_top(PLATE, places)[::order]
    at = middles(PLATE)[:, list(flat_axes(PLATE))] - PLATE[0].mean(axis=0)[list(flat_axes(PLATE))]
    expected = top(PLATE)
    for (x0, y0), (x1, y1) in zip(places, places[1:] + places[:1], strict=True):
        expected &= (x1 - x0) * (at[:, 1] - y0) - (y1 - y0) * (at[:, 0] - x0) > 0.0
    body = moved(PLATE, TURN, SHIFT) if turned_round else PLATE
    corners = TURN.apply(corners) + SHIFT if turned_round else corners
    chosen = faces_within(surface(body), corners * MM)
    assert 50 < expected.sum() < top(PLATE).sum()
    assert (chosen == expected).all(), "and none of the other side, 2 mm below"


def test_an_outline_with_a_bay_leaves_the_bay_out() -> None:
    outline = np.array([(0, 0), (10, 0), (10, 10), (6, 10), (6, 3), (4, 3), (4, 10), (0, 10)], float)
    points = np.random.default_rng(1).uniform(-2, 12, (4000, 2))
    arms = outline[None] - points[:, None]
    angle = np.arctan2(arms[..., 1], arms[..., 0])
    turns = np.angle(np.exp(1j * (np.roll(angle, -1, axis=1) - angle))).sum(axis=1) / (2.0 * np.pi)
    assert (even_odd(points, outline) == (np.abs(turns) > 0.5)).all()


def test_near_a_landmark_are_the_faces_of_its_own_side() -> None:
    body = moved(PLATE, TURN, SHIFT)
    point = TURN.apply(on_top(PLATE, [(3.0, -2.0)])) + SHIFT
    expected = top(PLATE) & (np.linalg.norm(middles(body) - point, axis=1) <= 8.0)
    assert expected.sum() > 30
    assert (faces_near(surface(body), point[0] * MM, 8e-3) == expected).all()


def test_another_body_of_the_file_under_the_polygon_does_not_count() -> None:
    body = joined(sphere(20.0, 8), moved(sphere(20.0, 8), turned(0, 0, 0), np.array([0.0, 0.0, -60.0])))
    angle = np.linspace(0.0, 2.0 * np.pi, 6, endpoint=False)
    corners = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle), np.full(6, np.sqrt(300.0))])
    chosen = faces_within(surface(body), corners * MM)
    assert chosen.any()
    assert middles(body)[chosen][:, 2].min() > 15.0
    assert np.hypot(*middles(body)[chosen][:, :2].T).max() < 10.0
    assert ((np.hypot(*middles(body)[:, :2].T) < 10.0 * np.cos(np.pi / 6)) & (middles(body)[:, 2] > 0) <= chosen).all()


def test_a_mesh_that_is_inside_out_gives_the_same_faces() -> None:
    corners = on_top(PLATE, [(-9, -9), (9, -9), (0, 9)]) * MM
    right = surface(PLATE)
    assert (
        faces_within(Surface(right.vertices, right.faces[:, ::-1].copy()), corners) == faces_within(right, corners)
    ).all()


@pytest.mark.parametrize(
    ("places", "words"),
    [
        ([(0, 0), (5, 5)], "needs 3 landmarks"),
        ([(-5, -5), (0, 0), (5, 5)], "in one line"),
        ([(0, 0), (0, 0), (0, 0)], "in one line"),
        ([(0, 0), (0, 0), (5, 5), (0, 0)], "in one line"),
        ([(-5, -5), (5, 5), (5, -5), (-5, 5)], "crosses itself"),
        ([(-8, -8), (8, -8), (0, 0), (8, 8), (-8, 8), (0, 0)], "comes back to a place"),
        ([(-8, -8), (8, -8), (8, 8), (0, -8), (-8, 8)], "crosses itself or comes back"),
        ([(-8, -8), (2, -8), (-3, -8), (8, -8), (8, 8)], "crosses itself or comes back"),
    ],
)
def test_what_has_no_inside_is_refused(places: list[tuple[float, float]], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        faces_within(surface(PLATE), on_top(PLATE, places) * MM)


def test_a_polygon_smaller_than_a_face_holds_none() -> None:
    assert not faces_within(surface(PLATE), on_top(PLATE, [(0.0, 0.0), (0.01, 0.0), (0.0, 0.01)]) * MM).any()


def along(places: list[tuple[float, float]], parts: int) -> list[tuple[float, float]]:
    """Corners at equal distances along each side of an outline."""
    ends = zip(places, places[1:] + places[:1], strict=True)
    return [(a + (c - a) * k / parts, b + (d - b) * k / parts) for (a, b), (c, d) in ends for k in range(parts)]


@pytest.mark.parametrize("turned_round", [False, True])
def test_corners_along_straight_edges_are_the_same_region_wherever_it_lies(turned_round: bool) -> None:
    """Sides in one line do not meet: a square, and an outline with a bay, whose edges beside it are in one line."""
    body = moved(PLATE, TURN, SHIFT) if turned_round else PLATE
    bay = [(0, 0), (30, 0), (30, 14), (20, 14), (20, 7), (10, 7), (10, 14), (0, 14)]
    for shape in ([(0, 0), (9, 0), (9, 9), (0, 9)], bay):
        for x, y in np.random.default_rng(3).uniform(-19.0, -11.0, (4, 2)):
            few = [(a + x, b + y) for a, b in shape]
            plain, dense = (on_top(PLATE, list(places)) for places in (few, along(few, 3)))
            chosen = [
                faces_within(surface(body), (TURN.apply(one) + SHIFT if turned_round else one) * MM)
                for one in (plain, dense)
            ]
            assert chosen[0].any()
            assert (chosen[0] == chosen[1]).all(), (x, y)


@pytest.mark.parametrize("again", [[0, 1, 2, 3, 0], [0, 0, 1, 2, 3], [0, 1, 1, 1, 2, 3], [0, 1, 2, 3, 3, 0, 0]])
def test_a_corner_given_again_next_to_itself_counts_once(again: list[int]) -> None:
    places = [(-11.0, -9.3), (12.2, -7.0), (9.1, 13.3), (-8.0, 7.7)]
    once = faces_within(surface(PLATE), on_top(PLATE, places) * MM)
    assert once.any()
    assert (faces_within(surface(PLATE), on_top(PLATE, [places[k] for k in again]) * MM) == once).all()
