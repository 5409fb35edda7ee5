"""A speed that is recorded wrong is found by the force along the floor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.below_knee_prosthesis.calibration.sole_residuals import slipping, with_slip
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.calibration.stances import planted, recorded


def test_error_of_the_speed_is_found() -> None:
    stance, foot = recorded(0.0), vsf_foot()
    zones, values = planted()
    keel = replace(foot, law=zones.law(values)).at(stance.fulcrum)
    wrong = np.tile([2e-3, -1e-3], (len(stance.time), 1))
    motion, slip = slipping(with_slip(stance, wrong), keel, 0.0 * wrong, 12)
    loaded = stance.force[:, 1] > 100.0
    assert loaded.sum() > 80
    before = with_slip(stance, wrong).solved(keel).force - stance.force
    after = motion.force - stance.force
    assert np.abs(before[loaded, 0]).max() > 50.0
    assert np.sqrt(np.mean(after[loaded][:, [0, 2]] ** 2)) < 0.02 * np.sqrt(np.mean(before[loaded][:, [0, 2]] ** 2))
    assert np.median(np.abs(slip + wrong)[loaded], axis=0).max() < 0.1e-3
