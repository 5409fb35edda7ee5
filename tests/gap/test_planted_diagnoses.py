"""Planted cases of the larger systems, diagnosed from end to end: their effects are named. How often that comes true is
the benchmark's question; these are cases of one of its runs that were right. All are synthetic."""

from __future__ import annotations

import pytest

from geocontact.data.diagnosis import Diagnosis
from geocontact.gap.diagnose import diagnose
from geocontact.gap_benchmark.drawing import Lot, drawn
from geocontact.gap_benchmark.synthetic.label import Label
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere

pytestmark = pytest.mark.slow

SEED = 20261145


def answered(system: str, kind: str, place: int) -> tuple[Label, Diagnosis]:
    """The truth of a planted case, and what is said of it."""
    planted = drawn(Lot(system, kind, SEED, place))
    return planted.label, diagnose(planted.case, system_of(planted.case)).diagnosis


@pytest.mark.slow
@pytest.mark.long  # with every change: sides that were exchanged, below; elbows in test_diagnose.py
@pytest.mark.parametrize(
    ("system", "kind", "place", "effects"),
    [
        ("foot", "single", 14, {"crosstalk"}),
        ("knee", "pair", 0, {"saturation", "axis_migration"}),
        ("shoulder", "single", 15, {"event_load"}),
        ("sit_to_stand", "single", 6, {"sensor_drift"}),
    ],
)
def test_what_was_planted_is_named(system: str, kind: str, place: int, effects: set[str], elsewhere: Elsewhere) -> None:
    truth, found = elsewhere(answered, system, kind, place)
    assert set(truth.effects) == effects, "drawn otherwise now: choose another place"
    assert found.verdict == "explained" and set(found.effects) == effects
    for channel, one in found.gap.items():
        assert one.reduction == pytest.approx(truth.reduction[channel], abs=0.15), channel
    assert found.where[0].p_value < 0.05


@pytest.mark.slow
def test_sides_that_were_exchanged_are_found_with_their_trials(elsewhere: Elsewhere) -> None:
    truth, found = elsewhere(answered, "knee", "fault", 0)
    assert tuple(truth.effects) == ("side_swap",), "drawn otherwise now: choose another place"
    assert found.effects == ("side_swap",)
    (mistake,) = found.faults
    assert mistake.effect == "side_swap" and set(mistake.trials) == set(truth.faulty)
