"""Numbers of leg, socket and foot that are simulated, by name."""

from __future__ import annotations

import numpy as np

from geocontact.below_knee_prosthesis.foot_numbers import (
    all_numbers,
    foot_numbers,
    leg_numbers,
    numbers_of,
    numbers_without_leg,
    socket_numbers,
)
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.contact.bushing import SOCKET
from tests.below_knee_prosthesis.model.legs import a_leg
from tests.below_knee_prosthesis.stances import FULCRUM, a_stance


def test_all_numbers_are_those_of_the_parts_and_gravity() -> None:
    found = all_numbers(a_leg(), vsf_foot(), FULCRUM, SOCKET)
    parts = (leg_numbers(a_leg()), socket_numbers(SOCKET), foot_numbers(vsf_foot(), FULCRUM))
    assert set(found) == {name for part in parts for name in part} | {"gravity"}
    assert len(found) == sum(map(len, parts)) + 1  # none of them hides another
    assert found["gravity"].value == 9.80665
    assert (found["leg mass"].value, found["fulcrum"].value) == (77.3, FULCRUM)
    assert found["socket_ty stiffness"].value == SOCKET.stiffness[4]
    assert set(numbers_without_leg(vsf_foot(), FULCRUM)) == {*parts[2], "gravity"}


def test_a_stance_has_the_numbers_that_it_was_simulated_with() -> None:
    stance = a_stance(np.arange(0.0, 0.1, 0.01))
    wanted = all_numbers(stance.motion.leg, stance.foot, stance.fulcrum, stance.bushing)
    assert numbers_of(stance) == wanted
