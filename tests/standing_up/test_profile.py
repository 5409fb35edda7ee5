"""Profiles of the feet's places on one trial: they rise as Laplace's intervals say, and only upwards."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.standing_up.chain import FOOT_PARAMETERS, Subject, feet_on_ground
from geocontact.standing_up.contact_numbers import contact_numbers
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.profile import FARTHEST, profiles
from geocontact.standing_up.strap_sites import usual
from geocontact.standing_up.trials import StandingNoise, recorded, standing_up


@pytest.mark.slow
def test_profiles_rise_as_the_curvature_says() -> None:
    """Near three standard deviations minus twice the log posterior is 9 higher, and a search from there is solved."""
    subject, noise, options = Subject(), StandingNoise(), SolverOptions("radau", 4, 20, 1e-7, 200)
    feet = feet_on_ground(subject)
    planted = usual(FOOT_PARAMETERS)
    planted[2] = 0.13
    _, truth = standing_up(feet, subject, planted=planted, intervals=20)
    phase = phase_a(feet, subject, [recorded(feet, truth.motions[0], truth.p, 100.0, noise, 34)], noise, free=("toe",))
    found = solve(phase.control, options)
    numbers = contact_numbers(phase, found)
    (toe,) = profiles(phase, found, numbers, 1, lambda held, warm: solve(held.control, options, warm=warm))
    assert (toe.name, toe.unit) == ("toe", "m")
    np.testing.assert_allclose(toe.distance, [-FARTHEST, 0.0, FARTHEST])
    sd = next(each.after for each in numbers.numbers if each.name == "toe")
    np.testing.assert_allclose(np.diff(toe.places), FARTHEST * sd, rtol=1e-6)
    assert toe.rise[1] == 0.0
    np.testing.assert_allclose(toe.rise[[0, 2]], FARTHEST**2, rtol=0.25)
