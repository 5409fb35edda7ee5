"""A foot on a plate from exact markers, the same stance on the whole model, and the limb's motion along it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.recorded_stance import (
    RecordedStance,
    WalkedStance,
    stance_on_plate,
    walked_stance,
)
from geocontact.below_knee_prosthesis.calibration.whole_calibration import along_limb, limb_on_sole
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import Walked, standing_leg
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import LegMotion
from geocontact.below_knee_prosthesis.simulate import simulate_stance
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg
from tests.below_knee_prosthesis.calibration.test_fit import usual_calibration
from tests.below_knee_prosthesis.from_markers.test_standing_and_walking import BELOW, seen
from tests.below_knee_prosthesis.walks import FULCRUM, TIME, a_walker, keel_of, plate, standing_markers, walking_values

FOOT = vsf_foot()


@pytest.fixture(scope="module")
def leg() -> Leg:
    walker = a_walker()
    return standing_leg(standing_markers(walker), walker.person, FOOT.keel, BELOW)


def on_keel(leg: Leg, share: float) -> np.ndarray:
    """A point that moves with the foot, at a share of its length from the heel."""
    keel = keel_of(leg, walking_values())
    return np.asarray(keel.apply([share * FOOT.keel.length, 0.0, 0.0]))


def stance_of(leg: Leg, own: PlateStance) -> RecordedStance:
    walking = seen(leg, walking_values(), TIME)
    return stance_on_plate(walking, leg, own, FOOT, FULCRUM, cutoff=None, gap_limit=0.1)


def test_a_centre_that_moves_with_the_foot_stays_where_it_is_on_it(leg: Leg) -> None:
    stance = stance_of(leg, plate(leg, 0.3, 0.9, on_keel(leg, 0.5)))
    inside = (stance.time > 0.33) & (stance.time < 0.87)
    np.testing.assert_allclose(stance.centre[inside], 0.5, atol=5e-3)
    assert stance.time[[0, -1]] == pytest.approx([0.24, 0.94], abs=0.021)
    assert stance.force[inside][:, 1] == pytest.approx(stance.weight)
    with pytest.raises(InputError, match=r"plates.mot `plate`: no plate under the foot: .* of left is not under it"):
        stance_of(leg, plate(leg, 0.3, 0.9, on_keel(leg, 1.7)))


def test_a_walked_stance_has_the_other_legs_push(leg: Leg) -> None:
    stance = stance_of(leg, plate(leg, 0.3, 0.9, on_keel(leg, 0.5)))
    fit = Walked(LegMotion(leg, TIME, walking_values()), np.zeros(len(TIME)))
    other = plate(leg, 0.0, 1.18)
    found = walked_stance(stance, fit, other, "walking.trc")
    assert found.recorded is stance and found.motion is fit.motion
    np.testing.assert_array_equal(found.push.force, other.force)
    late = Walked(LegMotion(leg, TIME[15:], walking_values()[15:]), np.zeros(len(TIME) - 15))
    with pytest.raises(InputError, match=r"walking.trc: markers are from 0.30 to 1.18 s, the stance from 0.2"):
        walked_stance(stance, late, other, "walking.trc")
    with pytest.raises(InputError, match="both need one clock"):
        walked_stance(stance, fit, PlateStance(TIME[5:], other.force[5:], other.centre[5:]), "")
    with pytest.raises(InputError, match="`other_plate`: the vertical force on left is 0 times"):
        walked_stance(stance, fit, replace(other, force=0.0 * other.force), "")


def test_a_limb_is_simulated_on_the_sole_that_was_found() -> None:
    """Without turns: the same as by hand, from the stance's begin to its end, with the foot beside its trial."""
    found = usual_calibration()
    one = course(true_leg(PARTICIPANTS[0], BELOW), FOOT, found.residuals.stances[0].fulcrum, 0.72)
    motion = one.motion.part(0.0, 0.2)
    recorded = replace(found.residuals.stances[0], time=0.08 + 0.005 * np.arange(20))
    stance = WalkedStance(recorded, motion, one.push)
    none = MarkerTrajectories(motion.time, np.zeros((len(motion.time), 0, 3)), (), "none")
    fit = Walked(motion, np.zeros(len(motion.time)))
    given = found, stance, none, fit
    limb = limb_on_sole(*given, cutoff=None, gap_limit=0.1, turns=0, machine_code=False)
    offset = found.offsets[0]
    moved = replace(motion, leg=motion.leg.with_foot(offset))
    span = stance.begin, float(recorded.time[-1])
    by_hand = simulate_stance(moved, found.foot, recorded.fulcrum, one.push, span, machine_code=False)
    np.testing.assert_array_equal(limb.stance.force, by_hand.force)
    assert limb.walked.motion.leg.offset == offset
    again = along_limb(stance, limb)
    assert again.motion.leg is motion.leg and again.motion.values is limb.walked.motion.values
