"""Which numbers matter: known effects, and none of what nothing depends on."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.device import Wearer
from geocontact.shoulder_exoskeleton.lucy import lucy
from geocontact.shoulder_exoskeleton.sensitivity import IDLE, STANDING, influences
from tests.shoulder_exoskeleton.arms import lifted


def test_the_cylinder_matters_and_its_lag_at_a_constant_level_does_not() -> None:
    device = lucy()
    found = {one.number: one for one in influences(lifted(seconds=4.5), device, Wearer(), 1.0)}
    assert set(found) <= set(device.numbers) - {*IDLE["point"], *STANDING}
    held = set(device.numbers) - set(found) - {*IDLE["point"], *STANDING}
    assert all(device[name] == 0.0 for name in held), held
    assert found["bore"].supporting > 2.0 and found["bore"].step == pytest.approx(0.0025)
    assert found["lag"].supporting == 0.0
    assert found["link_1_z"].elevation == pytest.approx(found["link_2_z"].elevation, abs=np.radians(0.05))
    assert found["link_2_z"].elevation > np.radians(0.5)
    assert all(one.most >= one.supporting for one in found.values())
