"""Another second, newton or metre changes no answer: a drift over a stretched clock, with stretched forces and lengths.

The case is synthetic; `benchmarks.gap.stretched` does the same to whole folders of cases.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from benchmarks.gap.stretched import SAME, Stretch, apart
from geocontact.data.diagnosis import Diagnosis
from geocontact.gap.diagnose import diagnose
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import elbow_case


def drifting(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
    """A sensor that drifts by enough to be worth naming: more than a tenth of the squared error."""
    return force + 0.2 * time


def stretched(**factors: Any) -> Diagnosis:
    """Diagnosis of the case in another world."""
    case = Stretch(**factors).case(elbow_case(seed=5, duration=8.0, change=drifting))
    return diagnose(case, system_of(case)).diagnosis


@pytest.mark.slow
def test_seconds_newtons_and_metres_are_no_part_of_the_answer(elsewhere: Elsewhere) -> None:
    here = elsewhere(stretched)
    assert here.effects == ("sensor_drift",)
    there = elsewhere(stretched, time=100.0, force=100.0, length=100.0)
    assert (there.verdict, there.effects) == (here.verdict, here.effects)
    assert apart(there.probabilities, here.probabilities) < SAME
    assert there.gap["force"].reduction == pytest.approx(here.gap["force"].reduction, abs=SAME)
