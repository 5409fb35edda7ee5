"""Residuals at the joint to the ground and what they are measured by, against numbers by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.multibody.joint import free, revolute
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.data.wrench import Wrench
from geocontact.dynamics.residuals import (
    GeneralisedForces,
    force_residual,
    largest_net_force,
    mean_height,
    moment_residual,
    verdict,
)

X, Y, Z = np.eye(3)
BODIES = (Body("pelvis", 3.0, 0.4 * Y, np.zeros((3, 3))), Body("thigh", 1.0, -0.4 * Y, np.zeros((3, 3))))
MODEL = Multibody("two", BODIES, (free("base", GROUND, "pelvis"), revolute("hip", "pelvis", "thigh", Z)), (), -10.0 * Y)


def forces(peak: float) -> GeneralisedForces:
    """Residuals 3, 4, 0 N at 0 s and 0, 0, 12 N at 1 s; 6 N m about two axes at 1 s; 90 N m at the hip."""
    values = np.array([[0.0, 0.0, 0.0, 3.0, 4.0, 0.0, -90.0], [6.0, 0.0, -8.0, 0.0, 0.0, 12.0, 1.0]])
    return GeneralisedForces(np.array([0.0, 1.0]), MODEL, values, peak, 0.9)


def test_sizes_of_residuals_leave_out_joints_between_bodies() -> None:
    found = forces(0.0)
    assert found.at_ground.tolist() == [True] * 6 + [False]
    np.testing.assert_allclose(found.residual_forces, [5.0, 12.0])
    np.testing.assert_allclose(found.residual_moments, [0.0, 10.0])
    assert found.residual == pytest.approx(np.sqrt((25.0 + 144.0) / 2.0))
    assert found.names[0] == "base_rx_moment" and found.names[3] == "base_tx_force"
    assert found.largest(~found.at_ground) == (0, 6) and found.largest(found.at_ground) == (1, 5)


def test_residuals_are_shares_of_the_largest_force_and_of_its_moment() -> None:
    """12 of 300 N are 4 %, 10 of 300 x 0.9 N m are 3.7 %: below 5 and above 1 %."""
    force, moment = force_residual(forces(300.0)), moment_residual(forces(300.0))
    assert (force.size, force.time, force.share, force.too_large) == (12.0, 1.0, pytest.approx(0.04), False)
    assert (moment.size, moment.share, moment.too_large) == (10.0, pytest.approx(10.0 / 270.0), True)


def test_without_loads_the_weight_is_the_whole() -> None:
    """4 kg in 10 m/s^2; a moment has nothing to be measured by."""
    force, moment = force_residual(forces(0.0)), moment_residual(forces(0.0))
    assert force.whole == 40.0 and force.share == pytest.approx(0.3) and force.too_large
    assert np.isnan(moment.share) and not moment.too_large


def test_a_chain_on_the_ground_has_no_residual() -> None:
    model = Multibody("held", BODIES[:1], (revolute("knee", GROUND, "pelvis", Z),), (), -10.0 * Y)
    found = GeneralisedForces(np.zeros(1), model, np.ones((1, 1)), 0.0, 0.0)
    assert np.isnan(found.residual) and found.residual_forces.tolist() == [0.0]


def test_loads_add_up_before_their_size_is_taken() -> None:
    """3 N to the side and 4 N up are 5 N; two that are opposite are nothing."""
    still = np.zeros((2, 3))
    one = Wrench(np.array([3.0 * X, 9.0 * X]), still, still, "ground")
    other = Wrench(np.array([4.0 * Y, -9.0 * X]), still, still, "ground")
    assert largest_net_force({"one": one, "other": other}) == 5.0 and largest_net_force({}) == 0.0


def test_the_mean_height_is_that_of_the_mass_centre() -> None:
    """(3 x 0.4 - 0.4) / 4 = 0.2 m in the pelvis, which stands 1 and 2 m high."""
    values = np.zeros((2, 7))
    values[:, 4] = 1.0, 2.0
    assert mean_height(MODEL, values) == pytest.approx(1.7)
    assert mean_height(Multibody("", BODIES, MODEL.joints, (), np.zeros(3)), values) == 0.0


@pytest.mark.parametrize(("size", "word"), [(10.0, "good"), (10.1, "okay"), (25.1, "bad")])
def test_opensim_s_words(size: float, word: str) -> None:
    assert verdict(size) == word
