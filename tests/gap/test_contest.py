"""Pairs of effects are searched for under quiet noise, each two effects once."""

from __future__ import annotations

from tests.elsewhere import Elsewhere
from tests.gap.cases import paired


def test_two_effects_are_found_and_each_two_are_tried_once(elsewhere: Elsewhere) -> None:
    names, gains = elsewhere(paired)
    assert names == [("damping", "sensor_drift"), ("damping", "end_stop")]
    assert gains[0] > 30.0
    assert gains[0] > gains[1] + 20.0
