"""Smoothed spheres: what the print's corrections are for, figures 8 and 9 as numbers, and OpenSim's own component."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.contact.smooth_half_space import (
    CONSTANT,
    HERTZ_SMOOTHING,
    HUNT_CROSSLEY_SMOOTHING,
    half_space_coefficient,
    half_space_force,
)
from geocontact.contact.smooth_hunt_crossley import smoothed_sphere_force, stribeck_coefficient
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

K, RADIUS, C = 1e6, 0.035, 1.5
SMOOTHING = (1e-3, HERTZ_SMOOTHING, HUNT_CROSSLEY_SMOOTHING, 0.5)
FRICTION = (0.2, 0.9, 0.7, 0.4)


def test_a_deep_sphere_presses_as_hunt_and_crossley_say() -> None:
    """Far from the gates only the rounding is left, (3/2) (e / 2x)^2 of the force, and eq 6's term."""
    x, rate = 0.02, 0.1
    bare = (4 / 3) * (0.5 * K ** (2 / 3)) ** 1.5 * np.sqrt(RADIUS) * x**1.5 * (1 + 1.5 * C * rate)
    found = smoothed_sphere_force(x, rate, K, RADIUS, C, 1e-3, 1e4, 50.0, 0.0)
    assert found == pytest.approx(bare * (1 + 1.5 * (1e-3 / 2 / x) ** 2), rel=1e-6)
    assert half_space_force(x, rate, K, RADIUS, C, 1e4, 50.0, 1e-10) == pytest.approx(bare, rel=1e-6)


@pytest.mark.parametrize("law", [smoothed_sphere_force, half_space_force])
def test_a_sphere_that_parts_pulls_by_no_more_than_its_gate(law) -> None:
    """min of y/(1 + exp(-2y)) is -0.13923 at y = -0.63923; times (3c/2)/b_v of the elastic force."""
    x, smoothing = 0.02, (1e-3, 1e4, 50.0, 0.0) if law is smoothed_sphere_force else (1e4, 50.0, 1e-5)
    rate = np.linspace(-2.0, 0.5, 25001)
    found = law(x, rate, K, RADIUS, C, *smoothing).min() / law(x, 0.0, K, RADIUS, C, *smoothing)
    assert found == pytest.approx(-0.13923 * 1.5 * C / 50.0, rel=1e-3)


def test_force_has_a_slope_without_contact() -> None:
    """Figure 8: less than 1 N out of contact and still a derivative."""
    x = np.linspace(-0.03, 0.02, 501)
    still = smoothed_sphere_force(x, 0.0, K, RADIUS, C, *SMOOTHING)
    assert (np.diff(still) > 0.0).all() and still[x <= -1e-3].max() < 1.0


@pytest.mark.parametrize("law", [smoothed_sphere_force, stribeck_coefficient])
def test_second_derivatives_do_not_jump(law) -> None:
    """Across the points where pieces meet, at 0, v_t and 3 v_t: the jump over a step shrinks with the step."""
    for at in (0.0, 0.2, 0.6) if law is stribeck_coefficient else (0.0,):
        jumps = []
        for h in (1e-3, 5e-4) if law is stribeck_coefficient else (2e-6, 1e-6):
            x = at + h * np.arange(-3, 4)
            numbers = FRICTION if law is stribeck_coefficient else (0.1, K, RADIUS, C, *SMOOTHING)
            second = np.diff(law(x, *numbers), 2) / h**2
            jumps.append(abs(second[-1] - second[0]))
        assert jumps[1] < 0.6 * jumps[0], (at, jumps)


def test_stribeck_curve_goes_through_its_numbers() -> None:
    """Figure 9: static at v_t, halfway at 2 v_t, dynamic from 3 v_t on, and the viscous part everywhere."""
    v_t, mu_s, mu_d, mu_v = FRICTION
    u = np.array([0.0, 0.5, 1.0, 2.0, 3.0, 10.0])
    wanted = np.array([0.0, mu_s / 2, mu_s, (mu_s + mu_d) / 2, mu_d, mu_d]) + mu_v * v_t * u
    np.testing.assert_allclose(stribeck_coefficient(v_t * u, *FRICTION), wanted, rtol=1e-14)


@pytest.mark.oracle
def test_form_of_opensim_is_opensims(opensim: Elsewhere) -> None:
    """Force of its `SmoothSphereHalfSpaceForce` on a sphere that moves without turning; 1e-9 of each size."""
    rng = np.random.default_rng(34)
    depth = np.r_[rng.uniform(-0.02, 0.01, 20), 0.0]
    velocity = rng.normal(size=(21, 2)) * [0.4, 0.2]  # along, upwards
    theirs = opensim(opensim_oracle.smooth_sphere, K, RADIUS, C, FRICTION, depth, velocity)
    pressing = half_space_force(
        depth, -velocity[:, 1], K, RADIUS, C, HERTZ_SMOOTHING, HUNT_CROSSLEY_SMOOTHING, CONSTANT
    )
    speed = np.sqrt(velocity[:, 0] ** 2 + CONSTANT)
    along = -pressing * half_space_coefficient(speed, *FRICTION) * velocity[:, 0] / speed
    np.testing.assert_allclose(theirs, np.column_stack([along, pressing]), rtol=1e-9, atol=1e-9)
