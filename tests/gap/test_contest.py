"""Pairs of effects are searched for under quiet noise, each two effects once."""

from __future__ import annotations

from tests.elsewhere import Elsewhere
from tests.gap.cases import paired


def test_two_effects_are_found_and_each_two_are_tried_once(elsewhere: Elsewhere) -> None:
    names, gains = elsewhere(paired)
    assert names[0] == ("damping", "sensor_drift")
    assert len(set(names)) == len(names) > 2
    assert all(len(set(two)) == 2 for two in names)
    assert list(gains) == sorted(gains, reverse=True)
    assert gains[0] > 30.0
