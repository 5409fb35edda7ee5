"""Tilt of a model's root body in a motion, and the turn that would undo it, against rotations by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.multibody.joint import free
from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.dynamics.tilt import root_tilt, shortest_turn

MODEL = Multibody("one body", (), (free("base", GROUND, "pelvis"),), (), np.array([0.0, -9.81, 0.0]))
AXES = [v for k in range(3) for v in (np.eye(3)[k], -np.eye(3)[k])]


def test_a_body_turned_about_x_is_tilted_by_that_angle() -> None:
    """Its y points along (0, cos, sin); frames that lack a coordinate of the root do not count."""
    values = np.zeros((5, 6))
    values[:3, 0], values[:, 4], values[3:, 5] = 1.2, 0.9, np.nan
    found = root_tilt(MODEL, values)
    assert found is not None and found.body == "pelvis"
    np.testing.assert_allclose(found.angle, 1.2, rtol=1e-12)
    np.testing.assert_allclose(found.up, [0.0, np.cos(1.2), np.sin(1.2)], atol=1e-12)


def test_nothing_is_known_without_gravity_or_a_free_body_or_a_frame() -> None:
    weightless = Multibody("", (), MODEL.joints, (), np.zeros(3))
    held = Multibody("", (), (), (), MODEL.gravity)
    assert root_tilt(weightless, np.zeros((1, 6))) is None and root_tilt(held, np.zeros((1, 0))) is None
    assert root_tilt(MODEL, np.full((2, 6), np.nan)) is None


@pytest.mark.parametrize("start", AXES)
@pytest.mark.parametrize("end", AXES)
def test_the_shortest_turn_leads_from_one_axis_to_the_other(start: np.ndarray, end: np.ndarray) -> None:
    """Its angle is that between both: the trace of a rotation is 1 + 2 cos."""
    turn = shortest_turn(0.9 * start + 0.05, end)
    np.testing.assert_allclose(turn @ start, end, atol=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1.0) and np.trace(turn) == pytest.approx(1.0 + 2.0 * (start @ end))
