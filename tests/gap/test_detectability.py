"""From which size on an effect is seen: power against its closed form, and a stated amplitude that is the smallest."""

from __future__ import annotations

import pytest

from geocontact.gap.identifiability.detectability import POWER
from tests.elsewhere import Elsewhere
from tests.gap.identifiability_cases import powers, smallest


def test_power_is_that_of_a_noncentral_chi_square_and_grows(elsewhere: Elsewhere) -> None:
    found = elsewhere(powers)
    drawn = [one for one, _ in found]
    assert drawn == sorted(drawn)
    assert drawn[0] < 0.2 and drawn[-1] > 0.9
    for one, exact in found:
        assert one == pytest.approx(exact, abs=0.035)


def test_the_stated_amplitude_is_seen_with_the_stated_power_and_half_of_it_is_not(elsewhere: Elsewhere) -> None:
    found = elsewhere(smallest)
    for label in ("damping", "dead_zone"):
        amplitude, nats, chance, at_half = found[label]
        assert amplitude is not None
        assert POWER <= chance < POWER + 0.05, label
        assert 6.0 < nats < 40.0, label
        assert at_half < 0.5, label
    assert found["sensor_gain.force"][0] is None
    assert found["sensor_gain.force"][2] < 0.1
