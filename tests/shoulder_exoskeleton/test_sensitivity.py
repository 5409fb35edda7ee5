"""Which numbers matter: known effects, and none of what nothing depends on."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.device import Wearer, lucy
from geocontact.shoulder_exoskeleton.sensitivity import AXES, IDLE, influences
from tests.shoulder_exoskeleton.arms import lifted


@pytest.mark.slow
def test_the_cylinder_matters_and_its_lag_at_a_constant_level_does_not() -> None:
    device = lucy()
    found = {one.number: one for one in influences(lifted(seconds=4.5), device, Wearer(), 1.0)}
    assert set(found) <= set(device.numbers) - {*IDLE["point"]}
    held = set(device.numbers) - set(found) - {*IDLE["point"]}
    along = {name for name in AXES if abs(device[name]) == 1.0}
    assert len(along) == 3 and along <= held and all(device[name] == 0.0 for name in held - along), held
    tilted = [found[name] for name in AXES if name not in along]
    assert len(tilted) == 6 and all(one.step == pytest.approx(np.tan(np.radians(5.0))) for one in tilted)
    assert max(one.elevation for one in tilted) > np.radians(0.3), "axes matter"
    assert found["bore"].supporting > 2.0 and found["bore"].step == pytest.approx(0.0025)
    assert found["lag"].supporting == 0.0
    assert found["arm_twist_gyration"].step == pytest.approx(2e-3) and found["arm_twist_gyration"].elevation > 0.0
    assert found["link_1_z"].elevation == pytest.approx(found["link_2_z"].elevation, abs=np.radians(0.05))
    assert found["link_2_z"].elevation > np.radians(0.5)
    assert all(one.most >= one.supporting for one in found.values())
