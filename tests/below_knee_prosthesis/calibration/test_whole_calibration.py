"""The sole on the whole model: its derivatives beside differences, and numbers that come back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance, WalkedStance
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WORTH, WholeCalibration, calibrate_whole
from geocontact.below_knee_prosthesis.calibration.whole_model import WholeResiduals, WholeStance
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg

FULCRUM, BELOW, LANDING = 0.1174, 0.03, (-0.03, 0.07)
PLANTED = np.array([0.4, -0.3, 0.0, 0.0, 0.0, 0.5, -0.4, 0.0, 0.0, 0.0, -0.2, 0.1, 0.0, 0.0, 0.0])
"""Logarithms; only the heel lands."""


@pytest.fixture(scope="module")
def landing() -> WalkedStance:
    """The heel of a person of 77 kg on a planted sole, by exact markers and an exact plate."""
    foot, leg = vsf_foot(), true_leg(PARTICIPANTS[0], BELOW)
    driven = course(leg, foot, FULCRUM, 0.72)
    time = np.arange(LANDING[0], LANDING[1], 0.005)
    n, weight = len(time), 77.3 * 9.80665
    poses = RigidTransform.from_translation(np.tile([0.1, 0.03, 0.0], (n, 1)))
    blank = RecordedStance(time, poses, np.zeros((n, 4, 4)), FULCRUM, np.zeros((n, 3)), np.zeros(n), weight)
    zones = ZoneParameters(foot.sole, foot.law)
    true = replace(foot, law=zones.law(zones.values_of(foot.law) * np.exp(PLANTED)))
    whole = WholeStance(WalkedStance(blank, driven.motion, driven.push), foot, machine_code=False)
    seen = whole.channels(whole.shown(true))
    assert seen[:, 1].max() > 0.3 * weight
    shown = RecordedStance(time, poses, np.zeros((n, 4, 4)), FULCRUM, seen[:, :3], seen[:, 3], weight)
    return WalkedStance(shown, driven.motion, driven.push)


@pytest.mark.slow
def test_derivatives_are_those_of_differences(landing: WalkedStance) -> None:
    """Along one direction of all fifteen numbers; where a sphere begins to slip, a difference is noise on the floor."""
    foot = vsf_foot()
    residuals = WholeResiduals([], foot, np.zeros(15), machine_code=False)
    whole = WholeStance(landing, foot, tolerance=1e-6, machine_code=False)
    direction, step = np.random.default_rng(2).uniform(-1.0, 1.0, 15), 1e-3
    exact = whole.slope(whole.shown(foot), residuals.chain(np.zeros(15)))
    up, down = (whole.channels(whole.shown(residuals.at(sign * step * direction))) for sign in (1.0, -1.0))
    differences = (up - down) / (2.0 * step)
    off, size = np.abs(exact @ direction - differences), np.nanmax(np.abs(differences), axis=0)
    assert np.nanmax(off[:, [1, 3]] / size[[1, 3]]) < 0.002
    assert (np.median(off[:, [0, 2]], axis=0) < 0.02 * size[[0, 2]]).all()
    assert size[1] > 50.0


@pytest.fixture(scope="module")
def found(landing: WalkedStance) -> WholeCalibration:
    return calibrate_whole([landing], vsf_foot(), np.zeros(15), machine_code=False)


@pytest.mark.slow
def test_planted_numbers_lie_in_their_intervals(found: WholeCalibration) -> None:
    known = np.array([each.verdict != "unknown" for each in found.knowledge.numbers])
    off = np.abs(found.logarithms - PLANTED)
    assert (off[known] < found.knowledge.half[known]).all()


@pytest.mark.slow
def test_planted_numbers_come_back(found: WholeCalibration) -> None:
    assert found.cost < 0.2 * found.begun
    assert found.logarithms[0] == pytest.approx(PLANTED[0], abs=0.1)
    off = found.residuals(PLANTED)
    assert found.cost < 0.5 * float(off @ off) + WORTH
    verdicts = {each.name: each.verdict for each in found.knowledge.numbers}
    assert verdicts["stiffness.heel_back"] == "known"
    assert verdicts["stiffness.forefoot"] == "unknown"
