"""Error of a pose carried into the area of a ball near a plate, whose area is linear in the gap: 2 pi R (T - h)."""

import numpy as np
import pytest

from geocontact.geometry.contact_area.pose_error import PoseError, error_of_area
from geocontact.geometry.contact_area.repeated import RepeatedArea
from meshes import simple_shapes as shapes
from tests.geometry.bodies import MM, surface, turned

R = 20.0
BALL, PLATE = surface(shapes.sphere(R, 16)), surface(shapes.block(80.0, 80.0, 12.0, 16), "plate")
RATE = 2.0 * np.pi * R * MM
TURN = turned(0, 0, 90).as_matrix()
"""The plate's normal, its y axis, along -x of the ball."""


@pytest.mark.parametrize(("axes", "place"), [("fixed", 0), ("moving", 1)])
def test_a_shift_along_the_normal_moves_the_area_by_the_cap(axes, place):
    sd = np.zeros(6)
    sd[place] = 0.3e-3
    error = PoseError.normal(sd, axes, 200, 3)
    found = error_of_area(RepeatedArea(BALL, PLATE, 4e-3), error, TURN, np.array([R + 1.5, 0.0, 0.0]) * MM)
    toward = -1.0 if axes == "fixed" else 1.0
    assert found.slope[place] == pytest.approx(toward * RATE, rel=0.01)
    assert found.first_order == pytest.approx(RATE * 0.3e-3, rel=0.01)
    np.testing.assert_allclose(found.drawn - found.nominal, toward * RATE * error.draws[:, place], atol=0.02e-5)
    others = np.delete(np.abs(found.slope[:3]), place)
    assert others.max() < 0.01 * RATE


def test_covariance_of_a_fit_is_that_of_its_draws():
    markers = np.array([[10.0, 80.0, 5.0], [-30.0, 90.0, 0.0], [5.0, 140.0, 40.0], [0.0, 60.0, -20.0]]) * MM
    error = PoseError.of_markers(markers, 0.5e-3, 1500, 2)
    scale = np.sqrt(np.diag(error.matrix))
    np.testing.assert_allclose(
        np.cov(error.draws.T) / np.outer(scale, scale), error.matrix / np.outer(scale, scale), atol=0.12
    )
