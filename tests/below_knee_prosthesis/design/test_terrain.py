"""A foot judged on a slope and on a step, beside the keel itself."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.design.foot_task import LEVEL, Terrain, words
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.design.tasks import a_task

PRESENT = 0.117


def judged(terrain: Terrain, vary: str = "fulcrum") -> np.ndarray:
    """Outcomes by response, value and aim."""
    settings = np.array([0.09, PRESENT]) if vary == "fulcrum" else np.array([0.0, 0.05])
    knob = Knob(vary, settings, PRESENT, terrain)  # type: ignore[arg-type]
    return knob.measured(knob.maps(vsf_foot(), a_task()), a_task())


def test_a_slope_turns_force_and_pitch_into_its_own_frame() -> None:
    """The force in the foot's own frame, and so every moment at one place of the foot, is what it was."""
    task, slope = a_task(), 0.08
    met = Terrain(slope).met(task)
    np.testing.assert_allclose(np.hypot(met.load, met.forward), np.hypot(task.load, task.forward))
    before = np.arctan2(task.load, task.forward) - task.pitch
    np.testing.assert_allclose(np.arctan2(met.load, met.forward) - met.pitch, before)


def test_uphill_with_angles_kept_is_a_foot_set_toes_down_on_a_floor() -> None:
    """Up to where the force points, which changes the load by next to nothing at 3 degrees."""
    uphill = judged(Terrain(0.05), "alignment")[0, 0]
    turned = Knob("alignment", np.array([-0.05, 0.0]), PRESENT)
    level = turned.measured(turned.maps(vsf_foot(), a_task()), a_task())[0, 0]
    energy = AIMS.index("energy")
    assert uphill[energy] == pytest.approx(level[energy], rel=0.1)
    flat = judged(LEVEL, "alignment")[0, 0]
    assert abs(uphill[energy] - level[energy]) < 0.2 * abs(uphill[energy] - flat[energy])


def test_on_a_step_the_heel_bears_nothing() -> None:
    """So the roll-over shape shortens, while the forefoot, which makes the ankle's moment, does what it did."""
    level, step = judged(LEVEL)[0], judged(Terrain(edge=0.06))[0]
    radius, moment = AIMS.index("radius"), AIMS.index("ankle_moment")
    assert (step[:, radius] < 0.9 * level[:, radius]).all()
    np.testing.assert_allclose(step[:, moment], level[:, moment], rtol=0.01)


def test_words() -> None:
    assert not words(LEVEL)
    assert (
        words(Terrain(-0.1, 0.06))
        == "on ground that falls by 5.72958°, on a step whose edge is 60 mm ahead of the heel"
    )
