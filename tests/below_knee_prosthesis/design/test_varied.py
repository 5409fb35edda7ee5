"""A foot varied along the shipped trial, without a command."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.drawn import RecordedTrial, without_map_error
from geocontact.below_knee_prosthesis.design.knob import AIMS, RESPONSES, Knob
from geocontact.below_knee_prosthesis.design.outcomes import outcomes
from geocontact.below_knee_prosthesis.design.varied import varied_foot
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.io.mocap.force_plates import read_force_plates
from geocontact.io.mocap.trc import read_trc
from tests.cli.calls import MESHES

TRIAL = MESHES / "gait_P1_medium_1"


@pytest.mark.slow
@pytest.mark.long  # with every change: the shipped trial in tests/analyses/prosthesis/test_design.py
def test_draws_lie_about_the_foot_as_it_is() -> None:
    """One drawn foot of a sole that is known, walked twice: near what the numbers as they are give."""
    foot, present = vsf_foot(), 0.1174
    own = next(each for each in read_force_plates(TRIAL / "plates.mot") if each.name == "own_force")
    plate = PlateStance(own.time, np.nan_to_num(own.wrench.force), own.centre_of_pressure(20.0))
    standing, walking = (read_trc(TRIAL / name) for name in ("standing.trc", "walking.trc"))
    trial = RecordedTrial(standing, walking, plate, Person(77.3), foot.keel, present, 0.03, 15.0, 0.2)
    sd, steps = np.full(len(ZoneParameters(foot.sole, foot.law).names), 1e-3), []
    knob = Knob("fulcrum", np.array([0.1, present, 0.14]), present)
    found = varied_foot(foot, trial, sd, knob, feet=1, walks=1, step=lambda: steps.append(1))
    assert len(steps) == 1 and found.drawn.lost == 0
    assert found.drawn.drawn.shape == (2, len(RESPONSES), 3, len(AIMS))
    assert found.ends.settings.tolist() == [0.1, present, 0.14] and len(found.held) == 3
    for aim in ("ankle_moment", "energy"):
        for k, shape in enumerate(found.shapes["angles kept"]):
            drawn = found.drawn.drawn[:, 0, k, AIMS.index(aim)].mean()
            assert drawn == pytest.approx(outcomes(shape)[aim], rel=0.15)
    names = [each.name for each in found.hangs_on]
    assert {"fulcrum", "alignment", "stiffness", "pitch", "load"} <= set(names)


def test_aims_without_an_error_of_the_map_are_known() -> None:
    """Nothing was measured of knee, hip, metabolic cost and landing: `design` says so where one of them is aimed at."""
    lacking = {aim for aim in AIMS if without_map_error(aim)}
    assert lacking == {"loading_rate", "knee_moment", "knee_mean", "hip_moment", "hip_mean", "metabolic"}
