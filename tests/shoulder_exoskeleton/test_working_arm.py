"""An arm at work by itself: phases by the tool, a controller beside a constant support, means by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.device import lucy
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from geocontact.shoulder_exoskeleton.support.controlled_arm import hand_controller
from geocontact.shoulder_exoskeleton.support.profile_limits import FactorKey
from geocontact.shoulder_exoskeleton.work_phases import PHASES
from geocontact.shoulder_exoskeleton.working_arm import SCREWING, SimulatedArm, arm_at_work, screw_in
from tests.shoulder_exoskeleton.arms import FITTING, lifted

MOTION = lifted()
TOOL = (MOTION.time >= 2.5) & (MOTION.time < 3.5)


@pytest.fixture(scope="module")
def arm() -> SimulatedArm:
    return arm_at_work(MOTION, lucy(), FITTING, 0.5, tool=TOOL)


def test_it_is_the_arm_under_a_constant_support_with_the_tool_s_phases(arm: SimulatedArm) -> None:
    alone = simulate_arm(MOTION, lucy(), FITTING, 0.5)
    np.testing.assert_array_equal(arm.simulation.angles, alone.angles)
    np.testing.assert_array_equal(arm.phase == SCREWING, TOOL)
    assert arm.detected is None and arm.factor is None and arm.side == "right"
    with pytest.raises(ValueError, match="the tool never runs while the arm is raised"):
        arm_at_work(MOTION, lucy(), FITTING, 0.5, tool=MOTION.time < 0.1)


def test_a_controller_that_gives_half_everywhere_is_half_a_level(arm: SimulatedArm) -> None:
    half = {FactorKey("T1", "other", phase): 0.5 for phase in PHASES}
    led = arm_at_work(
        MOTION, lucy(), FITTING, 1.0, tool=TOOL, controller=hand_controller(half, "T1", "other", 4.0 * TOOL)
    )
    assert led.detected is not None and set(led.detected) > {SCREWING}
    np.testing.assert_allclose(led.simulation.supporting, arm.simulation.supporting, atol=0.2)


def test_a_phase_without_a_factor_has_none() -> None:
    factors = {FactorKey("T1", "dominant", "lift"): 0.3, FactorKey("T1", "other", "lower"): 0.7}
    assert hand_controller(factors, "T1", "dominant", np.zeros(3)).factors.tolist() == [0.0, 0.3, 0.0, 0.0]


def test_means_of_the_screw_in_are_those_of_its_frames(arm: SimulatedArm) -> None:
    found = screw_in(arm)
    assert found.exoskeleton == pytest.approx(np.mean(arm.simulation.angles[TOOL, 2]))
    assert found.shoulder == pytest.approx(2.0), "the arm is held at 2 rad"
    assert found.force == pytest.approx(np.mean(arm.simulation.outputs["in_cuff"][TOOL, 2]))
    idle = SimulatedArm(arm.simulation, np.zeros(len(MOTION.time), int))
    assert np.isnan([screw_in(idle).exoskeleton, screw_in(idle).force]).all()
