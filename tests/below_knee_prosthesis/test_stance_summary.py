"""A simulated stance in a few numbers, and what it is doubted for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.below_knee_prosthesis.stance_summary import doubts, summary
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg
from tests.below_knee_prosthesis.stances import a_stance


def test_numbers_of_a_force_over_half_a_second() -> None:
    """1.2 times the weight of 77.3 kg from 0.1 to 0.6 s; neither socket nor keel gives."""
    time = np.arange(0.0, 0.8, 0.002)
    force = np.zeros((len(time), 3))
    force[(time > 0.0995) & (time < 0.6005), 1] = 1.2 * 77.3 * GRAVITY
    stance = a_stance(time, force)
    found = summary(stance)
    gate = 20.0 / (1.2 * 77.3 * GRAVITY)  # is passed between two samples, before and after
    assert found["stance_s"] == pytest.approx(0.5 + 2.0 * 0.002 * (1.0 - gate), rel=1e-9)
    assert found["vertical_max_BW"] == pytest.approx(1.2, rel=1e-12)
    arm = (np.array([0.1, 0.0, 0.0]) - stance.ankle[0])[0]  # of an upward force on the middle of the sole
    assert found["ankle_moment_max_N_m"] == pytest.approx(1.2 * 77.3 * GRAVITY * arm, rel=1e-9)
    assert (found["stored_max_J"], found["lost_J"], found["pistoning_max_mm"]) == (0.0, 0.0, 0.0)
    assert np.isnan(summary(a_stance(time))["stance_s"])


@pytest.fixture(scope="module")
def pressed() -> Stance:
    """Some milliseconds of a stance that begins with the foot on the floor."""
    leg = true_leg(PARTICIPANTS[0], 0.03)
    one = course(leg, vsf_foot(), 0.1174, 0.72)
    return simulate_stance(one.motion, vsf_foot(), 0.1174, one.push, (0.06, 0.07), machine_code=False)


def test_a_foot_on_the_floor_at_the_start_is_told(pressed: Stance) -> None:
    assert "the foot is on the floor at the start" in "; ".join(doubts(pressed))
    assert "never loaded: forefoot" in "; ".join(doubts(pressed))


def test_limits_of_the_socket_are_told(pressed: Stance) -> None:
    found = pressed.found
    q, u = found.q.copy(), found.u.copy()
    q[2:, 6], u[3:, 6], q[:, 2] = 0.036, 0.11, np.radians(25.0)
    told = "; ".join(doubts(replace(pressed, found=replace(found, q=q, u=u))))
    assert "the socket pistons by 36 mm, past 35 mm" in told
    assert "faster than 100 mm/s" in told
    assert "the socket turns by 25 degrees" in told
    assert "pistons" not in "; ".join(doubts(pressed))


def test_a_sphere_below_its_radius_is_told(pressed: Stance) -> None:
    depth = pressed.loads.depth.copy()
    depth[1, :3] = 0.023
    told = "; ".join(doubts(replace(pressed, loads=replace(pressed.loads, depth=depth))))
    assert "3 spheres sink beyond their radius, up to 23 mm" in told
