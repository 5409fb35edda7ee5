"""Scored as the study: swing that agrees by itself makes errors smaller, and says nothing for a fit."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from geocontact.analyses.prosthesis.compare.result import against_the_plates
from geocontact.analyses.prosthesis.scores import OVER, SCORES
from geocontact.analyses.prosthesis.simulate.result import against_the_plate
from geocontact.below_knee_prosthesis.evaluation import PlateStance, stance_errors
from geocontact.below_knee_prosthesis.simulate import Stance
from tests.below_knee_prosthesis.stances import a_stance
from tests.below_knee_prosthesis.test_stance_errors import plate_of, walked


@pytest.fixture(scope="module")
def too_large() -> tuple[Stance, PlateStance]:
    """A force 1.5 times that of the plate."""
    own = np.arange(-0.2, 1.1, 0.002)
    return a_stance(own, 1.5 * walked(own)), plate_of(np.arange(-0.3, 1.3, 0.002))


@pytest.mark.parametrize("score", ["stance", "study"])
def test_the_fit_is_tested_over_the_stance_whatever_is_scored(
    too_large: tuple[Stance, PlateStance], score: str
) -> None:
    scored = stance_errors(*too_large, SCORES[score]).table["resultant"][0]
    assert scored < 0.0 if score == "stance" else scored > 0.5
    name = f"resultant force{OVER[score]}"
    found = against_the_plate(*too_large, OVER[score])
    assert any(each.contradicts and each.what.startswith(name) for each in found.doubts)
    one: Any = SimpleNamespace(name="a", person="P", setting="low", calibrated=False, plate=too_large[1])
    study = against_the_plates([(one, too_large[0])], OVER[score])
    assert any(each.contradicts and each.what.startswith(name) for each in study.doubts)
