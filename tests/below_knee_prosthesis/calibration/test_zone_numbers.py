"""What intervals of a calibration say of each number of a sole."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot


def test_an_interval_is_as_wide_as_its_standard_deviation() -> None:
    """exp(±1.96 s) about a number; what has none, or a wider one, keeps its prior."""
    zones = ZoneParameters(vsf_foot().sole, vsf_foot().law)
    half = 1.959963984540054 * 0.2
    given = {"stiffness.forefoot": (4e4 * np.exp(-half), 4e4 * np.exp(half)), "friction.midfoot": (1e-6, 1e6)}
    found = dict(zip(zones.names, zones.sd_within(given), strict=True))
    prior = dict(zip(zones.names, zones.sd, strict=True))
    assert found.pop("stiffness.forefoot") == pytest.approx(0.2, rel=1e-12)
    assert found == {name: prior[name] for name in found}
    wider = zones.sd_within({"stiffness.forefoot": given["stiffness.forefoot"]}, level=0.5)
    assert wider.max() <= zones.sd.max()


@pytest.mark.parametrize("ends", [(0.0, 1.0), (2.0, 1.0), (1.0, np.inf), (-1.0, 1.0)])
def test_what_is_no_interval_is_refused(ends: tuple[float, float]) -> None:
    zones = ZoneParameters(vsf_foot().sole, vsf_foot().law)
    with pytest.raises(ValueError, match=r"damping.heel_back: .* is not an interval"):
        zones.sd_within({"damping.heel_back": ends})
