"""Outcomes hang on the foot's numbers as physics has it."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.foot_task import LEVEL
from geocontact.below_knee_prosthesis.design.knob import AIMS
from geocontact.below_knee_prosthesis.design.sensitivities import RECORDED, Unknown, sensitivities
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.design.tasks import a_task


@pytest.mark.slow
def test_of_a_stance() -> None:
    foot = vsf_foot()
    unknown = Unknown(ZoneParameters(foot.sole, foot.law).sd, np.radians(0.5), 0.01)
    found = {each.name: each for each in sensitivities(foot, a_task(), 0.1, LEVEL, unknown)}
    energy, moment, landing = (AIMS.index(aim) for aim in ("energy", "ankle_moment", "loading_rate"))
    kept = found["fulcrum"].change
    assert kept["angles kept"][energy] < 0.0 and kept["angles kept"][landing] == pytest.approx(0.0, abs=1e-6)
    assert abs(kept["torque kept"][moment]) < 1e-2 * abs(kept["angles kept"][moment])
    bent = found["bending of the keel"].change[RECORDED]
    assert bent[AIMS.index("radius")] > 0.0  # a stiffer keel rolls on a larger arc
    assert found["stiffness.heel_back"].change[RECORDED][landing] > 0.0
    load = found["load"].change[RECORDED]
    assert load[energy] > 0.0 and load[moment] > 0.0
    assert found["load"].by == pytest.approx(1.01)
