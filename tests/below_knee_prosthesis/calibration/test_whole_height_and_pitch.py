"""A foot out of flat on the whole model: height and pitch come back, by the differences that the search takes.

What the plate shows is simulated on a leg whose keel is moved by matrices. Derivatives by the sole's numbers, which
take minutes to make, are left at nothing: those numbers stay where they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.calibration import whole_model as whole_residuals
from geocontact.below_knee_prosthesis.calibration import whole_model as whole_stance
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance, WalkedStance
from geocontact.below_knee_prosthesis.calibration.whole_model import WholeResiduals, WholeStance
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.identify.optimise.bounded_gauss_newton import least
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg
from tests.below_knee_prosthesis.socket_markers import shift, turn

FULCRUM, BELOW, LANDING = 0.1174, 0.03, (-0.02, 0.06)
HEIGHT, PITCH = 0.5e-3, np.radians(0.4)
NOISE = np.array([3.0, 3.0, 3.0, 0.01])


@pytest.fixture(scope="module")
def residuals() -> Iterator[WholeResiduals]:
    """Of a landing heel, the foot 0.5 mm and 0.4 degrees beside its standing trial."""
    foot, leg = vsf_foot(), true_leg(PARTICIPANTS[0], BELOW)
    driven = course(leg, foot, FULCRUM, 0.72)
    time = np.arange(*LANDING, 0.005)
    n, weight, middle = len(time), 77.3 * 9.80665, np.array([0.11, 0.0, 0.0])
    before = np.eye(4)
    before[:3, :3] = leg.turn.as_matrix()
    there = shift(leg.keel) @ before @ shift(middle + np.array([0.0, HEIGHT, 0.0])) @ turn("z", PITCH) @ shift(-middle)
    moved = replace(leg, keel=there[:3, 3], turn=Rotation.from_matrix(there[:3, :3]))
    poses = RigidTransform.from_translation(np.tile([0.1, 0.03, 0.0], (n, 1)))
    blank = RecordedStance(time, poses, np.zeros((n, 4, 4)), FULCRUM, np.zeros((n, 3)), np.zeros(n), weight)

    def only_the_wrench(model: Any, *_: object) -> Any:
        from casadi import Function, densify

        wrench = Function("wrench", model.equations.state, [densify(model.on_sole)])
        return whole_stance._Tools(wrench, wrench, None)  # type: ignore[arg-type]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(whole_stance, "_tools", only_the_wrench)
        patch.setattr(whole_residuals, "noise_of", lambda *_: np.tile(NOISE, (n, 1)))
        patch.setattr(WholeStance, "slope", lambda self, shown, chain: np.zeros((n, 4, chain.shape[1])))
        true = WalkedStance(blank, replace(driven.motion, leg=moved), driven.push)
        whole = WholeStance(true, foot, machine_code=False)
        seen = whole.channels(whole.shown(foot))
        assert seen[:, 1].max() > 0.2 * weight
        recorded = replace(blank, force=seen[:, :3], centre=seen[:, 3])
        given = [WalkedStance(recorded, driven.motion, driven.push)]
        yield WholeResiduals(given, foot, np.zeros(17), machine_code=False)


@pytest.mark.slow
def test_planted_height_and_pitch_leave_nothing(residuals: WholeResiduals) -> None:
    e = residuals.wholes[0].stance.recorded.errors
    planted = np.concatenate([np.zeros(15), [HEIGHT / e.standing, PITCH / e.pitch]])
    assert np.abs(residuals.of_data(planted)).max() < 1e-3
    assert np.abs(residuals.of_data(np.zeros(17))).max() > 5.0
    np.testing.assert_array_equal(residuals.of_data(np.zeros(15)), residuals.of_data(np.zeros(17)))


@pytest.mark.slow
def test_height_and_pitch_come_back(residuals: WholeResiduals) -> None:
    reach = residuals.reach
    found = least(residuals, residuals.slope, np.zeros(17), -reach, reach, 12, 1e-3).x
    height, pitch = found[15:] * residuals.sizes
    assert height == pytest.approx(HEIGHT, abs=0.1e-3)
    assert pitch == pytest.approx(PITCH, abs=np.radians(0.08))
    assert np.abs(found[:15]).max() == 0.0
