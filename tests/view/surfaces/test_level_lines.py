"""Lines of equal distance lie where the closed form has them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.view.surfaces.legend import coloured, distance_limits, known_up_to, level_lines
from tests.view.surfaces.ball import GAP, LIMIT, MM, RADIUS, ball, plate, to_ball


def length(ends: np.ndarray) -> float:
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())


def test_length_of_a_circle_converges_at_second_order() -> None:
    """The line at 4 mm of a ball over a plate is a circle."""
    radius = np.sqrt((RADIUS + 4 * MM) ** 2 - (RADIUS + GAP) ** 2)
    cells = np.array([16, 32, 64, 128])
    error = []
    for n in cells:
        vertices, faces = plate(int(n))
        distance = np.linalg.norm(vertices - [0.0, RADIUS + GAP, 0.0], axis=1) - RADIUS
        ends, _ = level_lines(vertices, faces, distance, 4 * MM)
        error.append(abs(length(ends) - 2 * np.pi * radius))
    order = -np.polyfit(np.log(cells), np.log(error), 1)[0]
    assert order == pytest.approx(2.0, abs=0.3), f"observed order {order:.2f}, errors {error}"


@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3), st.floats(-0.02, 0.02))
def test_ends_lie_on_the_level_and_in_their_face(normal: list[float], level: float) -> None:
    vertices, faces = ball(4)
    values = vertices @ normal
    ends, index = level_lines(vertices, faces, values, level)
    assert np.allclose(ends @ normal, level, atol=1e-12)
    corners = vertices[faces[index]]
    off = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.allclose(np.einsum("sek,sk->se", ends - corners[:, :1], off), 0.0, atol=1e-12)


@given(st.sampled_from([(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1)]))
def test_a_closed_line_has_no_loose_end(order: tuple[int, int, int]) -> None:
    vertices, faces = ball(6)
    ends, _ = level_lines(vertices, faces[:, order], vertices[:, 1], 0.3 * RADIUS)
    _, count = np.unique(np.round(ends.reshape(-1, 3) / 1e-12), axis=0, return_counts=True)
    assert len(ends) and (count == 2).all()


def test_no_line_where_the_distance_is_not_known() -> None:
    vertices, faces = plate(10)
    assert len(level_lines(vertices, faces, np.full(len(vertices), np.inf), 1.0)[0]) == 0
    values = np.where(vertices[:, 0] > 0.0, np.inf, 0.0)
    assert len(level_lines(vertices, faces, values, 1.0)[0]) == 0
    assert len(level_lines(vertices, faces, np.zeros(len(vertices)), 0.0)[0]) == 0


def test_a_value_on_the_level_is_below_it() -> None:
    """As in the area: the triangle at the level has no line, the one that rises from it has one along the edge."""
    vertices, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), np.array([[0, 1, 2], [1, 3, 2]])
    ends, index = level_lines(vertices, faces, np.array([2.0, 2.0, 2.0, 3.0]), 2.0)
    assert index.tolist() == [1]
    assert {tuple(end) for end in ends[0]} == {(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)}


def test_colours_end_where_the_distance_is_known_everywhere() -> None:
    """A ball over a plate: the edge of what is known is a circle, not a saw."""
    vertices, faces = plate(40)
    distance = to_ball(vertices, np.array([0.0, RADIUS + GAP, 0.0]))
    known = known_up_to(distance, faces)
    edge = 2 * 30 * MM / 40 * np.sqrt(2.0)
    assert LIMIT - edge < known <= LIMIT
    reached = faces[(distance[faces] < known).any(axis=1)]
    assert np.isfinite(distance[reached]).all()
    assert known_up_to(np.zeros(len(vertices)), faces) == np.inf
    assert known_up_to(np.full(len(vertices), np.inf), faces) == np.inf
    assert known_up_to(np.stack([distance, np.zeros(len(vertices))]), faces) == known


@pytest.mark.parametrize("known", [3e-3, 7e-3, np.inf])
def test_colours_are_those_of_the_figure_and_grey_beyond(known: float) -> None:
    from matplotlib import colormaps

    distance = np.array([-np.inf, -1e-3, 0.0, 2e-3, 2.9e-3, 6.9e-3, 7.9e-3, np.inf])
    values, colours, (lower, top) = coloured(distance, (1e-3, 4e-3), known)
    assert (lower, 8e-3) == distance_limits((1e-3, 4e-3)) == (-2e-3, 8e-3)
    assert np.isfinite(values).all() and values.min() >= lower and values.max() <= top
    seen = colours[np.rint((values - lower) / (top - lower) * 1023).astype(int)]
    expected = colormaps["viridis_r"]((np.clip(distance, lower, 8e-3) - lower) / (8e-3 - lower))[:, :3]
    grey = distance > known
    assert np.abs(seen - expected)[~grey].max() < 0.02
    assert np.ptp(seen[grey], axis=1).max(initial=0.0) == 0.0 and (not grey.any() or seen[grey].min() > 0.8)
