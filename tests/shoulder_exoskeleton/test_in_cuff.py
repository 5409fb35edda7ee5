"""An arm that is not in its cuff is no result, and what is wrong is asked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.cuff_contact import MOST_LOST, OutOfCuffError, require_in_cuff
from geocontact.shoulder_exoskeleton.device import Device, Wearer, lucy
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from tests.shoulder_exoskeleton.arms import lifted

LUCY, WEARER = lucy(), Wearer()
HUNDRED = np.arange(100) * 0.01


def judged(along: np.ndarray, device: Device = LUCY, wearer: Wearer = WEARER, **motion: np.ndarray) -> None:
    """An arm that points straight to the front, its sphere 216 mm from a hinge beside the shoulder."""
    rows = np.ones((100, 1))
    arm = {
        "shoulder": rows * [0.0, -0.03, 0.0],
        "interface": rows * [0.0, -0.22, 0.0],
        "elevation": np.linspace(0.2, 1.6, 100),
    }
    still = ArmMotion("right", HUNDRED, gravity=np.array([0.0, 0.0, -9.81]), **(arm | motion))
    require_in_cuff(still, device, wearer, along, rows * [-0.05, 0.0, 0.0])


def places(out: int, far: float = 0.09) -> np.ndarray:
    """So many of a hundred beyond the end at 60 mm, most of them by more than half of the radius of 50 mm."""
    return np.where(np.arange(100) < out, far, 0.0)


def test_a_quarter_of_the_time_is_the_limit() -> None:
    assert pytest.approx(0.25) == MOST_LOST
    judged(places(25))
    with pytest.raises(OutOfCuffError, match=r"26% of the time, between 0\.00 and 0\.25 s, up to 30 mm beyond its end"):
        judged(places(26))


def test_half_a_radius_beyond_the_end_is_not_lost() -> None:
    """25 of 50 mm; without support the device slides there on the shipped trial."""
    judged(places(100, 0.084))
    with pytest.raises(OutOfCuffError, match="100% of the time"):
        judged(places(100, 0.086))


def test_exchanged_markers_are_named() -> None:
    """The upper marker is where the hand's side should be, and the arm never comes down."""
    turned = {
        "shoulder": np.ones((100, 1)) * [0.0, -0.22, 0.0],
        "interface": np.ones((100, 1)) * [0.0, -0.03, 0.0],
        "elevation": np.linspace(1.0, 2.9, 100),
    }
    with pytest.raises(OutOfCuffError, match=r"are humerus_rup and humerus_rdn exchanged\?"):
        judged(-places(100, 0.15), **turned)


def test_a_length_that_fits_is_proposed() -> None:
    """180 mm are set; the sphere is 70 … 110 mm beyond the middle, as with an arm 90 / 0.72 mm longer."""
    along = np.linspace(0.070, 0.110, 100)
    with pytest.raises(OutOfCuffError, match="180 mm are set, 305 mm would put the cuff where the sphere is"):
        judged(along, wearer=Wearer(upper_arm=0.18))


def test_a_short_cuff_is_named() -> None:
    with pytest.raises(OutOfCuffError, match="slides over 100 mm, the cuff is 20 mm long"):
        judged(np.linspace(-0.05, 0.05, 100), LUCY.having(cuff_length=0.02))


def test_where_no_length_fits_the_unit_is_asked_for() -> None:
    with pytest.raises(OutOfCuffError, match="are unit and names of the markers right"):
        judged(np.full(100, 0.3))


def test_a_simulation_asks_unless_the_share_is_given_away() -> None:
    """An arm 45 cm long whose sphere is lifted by 10 cm."""
    motion = lifted()
    far = replace(motion, interface=motion.interface + np.array([0.0, 0.0, 0.1]))
    with pytest.raises(OutOfCuffError, match="the sphere is far out of the cuff for 100% of the time"):
        simulate_arm(far, LUCY, Wearer(upper_arm=0.45), 0.0)
    assert simulate_arm(far, LUCY, Wearer(upper_arm=0.45), 0.0, most_lost=1.0).out_of_cuff.all()
