"""A walk from exact markers and a made-up plate, and the stance along it, without a command."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import Walked
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg import FootOffset, Leg
from geocontact.below_knee_prosthesis.recorded_walk import SeenFoot, Walk, fitted_walk, simulated_walk
from geocontact.below_knee_prosthesis.simulate import simulate_stance
from geocontact.below_knee_prosthesis.stance_model import FLOOR
from geocontact.contact.bushing import SOCKET
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg
from tests.below_knee_prosthesis.from_markers.test_standing_and_walking import BELOW, seen
from tests.below_knee_prosthesis.walks import (
    FULCRUM,
    TIME,
    a_walker,
    keel_of,
    plate,
    standing_markers,
    walking_values,
)

LEVEL = np.array([1.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def leg() -> Leg:
    return a_walker()


@pytest.fixture(scope="module")
def standing(leg: Leg) -> MarkerTrajectories:
    return standing_markers(leg)


@pytest.fixture(scope="module")
def values() -> np.ndarray:
    return walking_values()


def heel_of(leg: Leg, values: np.ndarray) -> np.ndarray:
    """Below the keel's posterior end, on the floor."""
    return keel_of(leg, values).translation * LEVEL


def test_leg_and_motion_are_those_that_made_the_markers(
    leg: Leg, standing: MarkerTrajectories, values: np.ndarray
) -> None:
    walking, exact = seen(leg, values, TIME), {"cutoff": None, "gap_limit": 0.1}
    other, own = plate(leg, 0.0, 1.18), plate(leg, 0.3, 0.9, heel_of(leg, values))
    walk = fitted_walk(standing, walking, leg.person, vsf_foot(), FULCRUM, other, plate=own, **exact)
    assert walk.leg.thigh == pytest.approx(leg.thigh, abs=1e-9)
    np.testing.assert_allclose(walk.leg.keel, leg.keel, atol=1e-9)
    np.testing.assert_allclose(walk.walked.motion.values, values, atol=1e-6)
    assert walk.off < 1e-7
    np.testing.assert_array_equal(walk.push.force, other.force)
    np.testing.assert_allclose(walk.cluster.poses.translation[:, ::2], heel_of(leg, values)[:, ::2], atol=2e-3)
    # 0.12 s before the stance on the plate to 0.1 s after it; without a plate all but two frames at both ends
    assert walk.span == pytest.approx((0.18, 1.0), abs=0.021)
    assert replace(walk, plate=None).span == pytest.approx((0.04, 1.14))
    raised = fitted_walk(
        standing, walking, leg.person, vsf_foot(), FULCRUM, other, offset=FootOffset(height=1e-3), **exact
    )
    np.testing.assert_allclose(
        raised.leg.turn.inv().apply(raised.leg.keel - walk.leg.keel), [0.0, 1e-3, 0.0], atol=1e-9
    )


def test_what_does_not_belong_together_is_refused(leg: Leg, standing: MarkerTrajectories, values: np.ndarray) -> None:
    walking, other = seen(leg, values, TIME), plate(leg, 0.0, 1.18)
    fitted = standing, walking, leg.person, vsf_foot(), FULCRUM
    far = plate(leg, 0.3, 0.9, heel_of(leg, values) + np.array([0.9, 0.0, 0.0]))
    for own, words in (
        (far, "no plate under the foot: the centre of pressure of left is 0.90 m from its heel"),
        (plate(leg, 0.0, 0.6, heel_of(leg, values)), "carries no whole stance above 20 N"),
    ):
        with pytest.raises(InputError, match=words):
            fitted_walk(*fitted, other, plate=own, cutoff=None)
    short = PlateStance(TIME[:30], other.force[:30], other.centre[:30], "right", "plates.mot")
    with pytest.raises(InputError, match="both need one clock; cut with `time`"):
        fitted_walk(*fitted, short, cutoff=None)
    light = replace(other, force=0.1 * other.force)
    with pytest.raises(InputError, match=r"`other_plate`: the vertical force on left is 0\.1 times body weight"):
        fitted_walk(*fitted, light, cutoff=None)


def test_a_walk_is_simulated_over_its_span() -> None:
    """Eight hundredths of a second without a plate, the socket counted twice: the same as by hand."""
    one = course(true_leg(PARTICIPANTS[0], BELOW), vsf_foot(), FULCRUM, 0.72)
    motion = one.motion.part(0.0, 0.08)
    none = MarkerTrajectories(motion.time, np.zeros((len(motion.time), 0, 3)), (), "none")
    still = SeenFoot(motion.time, RigidTransform.identity(len(motion.time)))
    fit = Walked(motion, np.zeros(len(motion.time)))
    walk = Walk(motion.leg, fit, FLOOR, vsf_foot(), FULCRUM, one.push, None, still, none)
    found = simulated_walk(walk, turns=0, machine_code=False)
    span = float(motion.time[2]), float(motion.time[-3])
    by_hand = simulate_stance(
        motion, vsf_foot(), FULCRUM, one.push, span, bushing=SOCKET, ground=FLOOR, machine_code=False
    )
    np.testing.assert_array_equal(found.stance.force, by_hand.force)
    assert found.stance.time[[0, -1]] == pytest.approx(span, abs=2e-3) and not found.settled
