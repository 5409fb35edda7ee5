"""What a calibration on the sole makes least, where three compressions cannot all be met."""

from __future__ import annotations

from dataclasses import replace
from math import log

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.keel.compression import (
    FOREFOOT,
    TRAVEL,
    Compressed,
    calibrated_on_sole,
    pressed_sole,
)
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot


def test_three_compressions_by_hand() -> None:
    """Σ log(F / (K d))²: no EI and no stiffness of the forefoot beside those that were found has less."""
    foot = vsf_foot()
    seen = [Compressed(0.07, 11e3), Compressed(0.1, 21e3), Compressed(0.14, 29e3)]
    keel, law = calibrated_on_sole(foot.keel, foot.sole, foot.law, seen)
    fore = foot.sole.spheres.zones[FOREFOOT]

    def squares(bent: float, pressed: float) -> float:
        stiffness = law.stiffness.copy()
        for k in range(len(stiffness)):
            stiffness[k] *= pressed if fore[k] else 1.0
        beam = replace(keel, bending=bent * keel.bending, torsional=bent * keel.torsional)
        spheres = replace(law, stiffness=stiffness)
        total = 0.0
        for each in seen:
            force = pressed_sole(beam, each.fulcrum, foot.sole, spheres, np.array([TRAVEL]))[0]
            total += log(force / (TRAVEL * each.stiffness)) ** 2
        return total

    here = squares(1.0, 1.0)
    assert here > 1e-4, "they contradict each other"
    for bent, pressed in ((1.01, 1.0), (1.0, 1.02), (1.01, 1.02), (1.01, 0.98)):
        ahead, behind = squares(bent, pressed), squares(1.0 / bent, 1.0 / pressed)
        assert ahead > here < behind
        assert abs(ahead - behind) < 0.05 * (ahead + behind - 2.0 * here)
    np.testing.assert_array_equal(law.stiffness[~fore], foot.law.stiffness[~fore])
    assert keel.torsional / keel.bending == pytest.approx(foot.keel.torsional / foot.keel.bending, rel=1e-12)
