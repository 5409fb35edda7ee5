"""A view is a direction; a shot takes in everything."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geocontact.view.surfaces.camera import LARGEST, Shot, View
from tests.view.surfaces.ball import MM, RADIUS, scene

directions = st.tuples(*[st.floats(-10, 10)] * 3)


@given(directions)
def test_axes_are_right_handed_and_look_the_right_way(towards: tuple[float, float, float]) -> None:
    assume(np.linalg.norm(towards) > 1e-3)
    axes = View("any", towards).axes()
    assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[2] @ towards == pytest.approx(np.linalg.norm(towards))


def test_named_views_of_a_right_knee() -> None:
    """x anterior, y superior, z right: seen from the front the subject's right is at the picture's left."""
    assert np.allclose(View("anterior", (1.0, 0.0, 0.0)).axes()[:2], [[0, 0, -1], [0, 1, 0]])
    assert np.allclose(View("superior", (0.0, 2.0, 0.0)).axes()[:2], [[0, 0, 1], [1, 0, 0]])
    assert np.allclose(View("plantar", (0.0, -1.0, 0.0), up=(1.0, 0.0, 0.0)).axes()[:2], [[0, 0, -1], [1, 0, 0]])


@pytest.mark.parametrize(("towards", "up"), [((0, 0, 0), None), ((1, 0, 0), (2, 0, 0)), ((np.nan, 0, 0), None)])
def test_no_direction_is_refused(towards: tuple[float, float, float], up: tuple[float, float, float] | None) -> None:
    with pytest.raises(ValueError, match="view odd"):
        View("odd", tuple(float(c) for c in towards), up and tuple(float(c) for c in up)).axes()


@given(directions, st.floats(-50, 50))
def test_a_shot_takes_in_both_bodies(towards: tuple[float, float, float], x: float) -> None:
    assume(np.linalg.norm(towards) > 1e-3)
    shown = scene(centre=(x * MM, RADIUS, 0.0))
    shot = Shot.of(shown, View("any", towards))
    points = np.vstack([shown.fixed_vertices, shown.moving_vertices])
    assert (np.abs(shot.project(points)) <= shot.half).all()
    assert max(shot.pixels[0] / LARGEST[0], shot.pixels[1] / LARGEST[1]) == pytest.approx(1.0)
    assert shot.pixels[0] / shot.pixels[1] == pytest.approx(shot.half[0] / shot.half[1], rel=0.01)


def test_vertices_without_a_face_do_not_count() -> None:
    shown = scene()
    stray = np.vstack([shown.fixed_vertices, [[9.0, 9.0, 9.0]]])
    more = scene(fixed_vertices=stray, distance=np.append(shown.distance, np.inf))
    view = View("any", (1.0, 2.0, 3.0))
    assert np.array_equal(Shot.of(shown, view).half, Shot.of(more, view).half)
