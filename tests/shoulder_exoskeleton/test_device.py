"""Lucy's numbers: what the paper's own numbers imply, completeness, the cylinder's triangle."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.parameter import SOURCES
from geocontact.shoulder_exoskeleton.device import (
    BUILT_IN,
    QUANTITIES,
    cylinder_length,
    lever,
    lucy,
    lucy_new_cylinder,
    piston_area,
)
from geocontact.shoulder_exoskeleton.support.arm_trial import support_of


def test_the_papers_numbers_agree_with_each_other() -> None:
    """482 N at 6 bar is a bore of 32 mm; 60 % of it one of 25 mm; both peak torques have one lever."""
    assert piston_area(0.032) * 6e5 == pytest.approx(482.0, abs=0.6)
    assert piston_area(0.025) / piston_area(0.032) == pytest.approx(0.60, abs=0.015)
    assert pytest.approx((25.0 / 32.0) ** 2, abs=1e-3) == 7.8 / 12.8
    assert 7.8 / (piston_area(0.025) * 6e5) == pytest.approx(0.0265, abs=5e-5)
    assert 12.8 / (piston_area(0.032) * 6e5) == pytest.approx(0.0265, abs=5e-5)


def test_the_devices_have_the_papers_peak_torques() -> None:
    assert lucy().peak_torque == pytest.approx(7.8, abs=0.01)
    assert lucy_new_cylinder().peak_torque == pytest.approx(12.8, abs=0.02)
    angle = np.linspace(0.0, np.pi, 2001)
    d = lucy()
    arms = lever(angle, d["lever_a"], d["lever_b"], d["lever_phase"])
    assert arms.max() * d.peak_force == pytest.approx(d.peak_torque, rel=1e-6)
    assert arms[0] == 0.0


def test_peak_torques_of_the_support_are_those_of_the_paper() -> None:
    angles = np.linspace(0.0, np.pi, 2001)
    for device, peak in ((lucy(), 7.8), (lucy_new_cylinder(), 12.8)):
        assert support_of(device).torque(angles).max() == pytest.approx(peak, abs=0.02)
        assert support_of(device).lag == device["lag"]


def test_the_lever_is_the_slope_of_the_cylinders_length() -> None:
    angle = np.linspace(0.1, 2.9, 1001)
    slope = np.gradient(cylinder_length(angle, 0.0265, 0.15, 0.2), angle)
    np.testing.assert_allclose(slope[1:-1], lever(angle, 0.0265, 0.15, 0.2)[1:-1], atol=1e-7)


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_number_is_there_within_its_range_and_says_where_it_is_from(name: str) -> None:
    device = BUILT_IN[name]()
    assert device.name == name and set(device.numbers) == set(QUANTITIES)
    for key, number in device.numbers.items():
        assert QUANTITIES[key].lower <= number.value <= QUANTITIES[key].upper, key
        assert number.source in SOURCES
        assert number.source == "invented" or number.note, key


def test_the_larger_cylinder_is_heavier_unless_it_is_left_out() -> None:
    now, new, light = (BUILT_IN[name]()["cylinder_mass"] for name in BUILT_IN)
    assert light == now < new == pytest.approx(now * 482.5 / 294.5, rel=1e-3)
