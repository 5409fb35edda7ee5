"""Error of a pose carried into the area of a ball near a plate, whose area is linear in the gap: 2 pi R (T - h)."""

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import AS_GIVEN
from geocontact.geometry.contact_area.evolution import Settings, area_evolution
from geocontact.geometry.contact_area.pose_error import (
    ErrorOfArea,
    PoseError,
    agreement,
    area_uncertainty,
    error_of_area,
    known_deviation,
)
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


@pytest.mark.parametrize("draws", [20, 50, 400])
def test_the_error_of_a_deviation_is_that_of_repeated_draws(draws: int) -> None:
    """Of 4000 sets of normal draws 95 % have the true deviation in their interval, as many missed on either side."""
    sets = np.random.default_rng(7).normal(0.0, 5.0, (4000, draws))
    _, lower, upper = known_deviation(sets.std(axis=1, ddof=1), draws)
    assert np.mean(lower > 5.0) == pytest.approx(0.025, abs=0.0075)
    assert np.mean(upper < 5.0) == pytest.approx(0.025, abs=0.0075)


def test_chance_of_few_draws_is_no_disagreement() -> None:
    """Draws of the first-order distribution itself: of 400 sets of 25, hardly any is taken for another one."""
    rng = np.random.default_rng(4)
    said = [agreement(ErrorOfArea(100.0, rng.normal(100.0, 5.0, 25), np.zeros(6), 5.0)) for _ in range(400)]
    assert said.count("yes") >= 396
    assert agreement(ErrorOfArea(100.0, rng.normal(100.0, 10.0, 400), np.zeros(6), 5.0)).startswith(
        "no: the area is not linear"
    )
    assert agreement(ErrorOfArea(100.0, rng.normal(103.0, 5.0, 400), np.zeros(6), 5.0)).startswith(
        "no: the mean of the draws"
    )


def test_over_a_motion_the_cap_of_each_frame_moves_with_its_gap():
    """Plate beside the ball, 1.5 and 3.9 mm away, then out of reach: 2 pi R (4 mm - gap), some draws with none."""
    heights = np.array([R + 1.5, R + 3.9, R + 9.0]) * MM
    shift = np.column_stack([heights, np.zeros(3), np.zeros(3)])
    motion = Motion(0.5 * np.arange(3), RigidTransform.from_components(shift, Rotation.from_matrix([TURN] * 3)))
    settings, steps = Settings((4e-3,), refinement=AS_GIVEN), []
    error = PoseError.normal(np.array([0.3e-3, 0, 0, 0, 0, 0]), "fixed", 60, 3)
    areas = area_evolution(PLATE, BALL, motion, settings)
    found = area_uncertainty(PLATE, BALL, motion, settings, areas, error, 1, lambda: steps.append(1))
    assert len(steps) == 3
    by_hand = np.maximum(RATE * (4e-3 - (heights[:2, None] - R * MM) - error.draws[:, 0]), 0.0)
    np.testing.assert_allclose(found.drawn(0)[:2], by_hand, atol=0.03e-4)
    assert found.verdict(0, 0) == found.verdict(2, 0) == "yes"
    assert found.verdict(1, 0).startswith("no: contact vanishes in ")
    np.testing.assert_allclose(found.interval(0)[:, 0], np.quantile(by_hand[0], (0.025, 0.975)), rtol=0.01)
    table = found.table(motion.time, settings.thresholds)
    assert table["time [s]"].tolist() == [0.0, 0.5, 1.0]
    assert table["drawn_sd [mm^2]"][0] == pytest.approx(by_hand[0].std(ddof=1) * 1e6, rel=0.01)
    assert table["slope_tx [mm^2/mm]"][0] == pytest.approx(-2.0 * np.pi * R, rel=0.01)
