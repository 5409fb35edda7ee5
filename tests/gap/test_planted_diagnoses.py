"""Planted cases of the larger systems, diagnosed from end to end: their effects are named. How often that comes true is
the benchmark's question; these are cases of one of its runs that were right. All are synthetic."""

from __future__ import annotations

import pytest

from geocontact.data.diagnosis import Diagnosis
from geocontact.gap.benchmark.drawing import Lot, drawn
from geocontact.gap.diagnose import diagnose
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere

SEED = 20261145


def answered(system: str, kind: str, place: int) -> tuple[tuple[str, ...], tuple[str, ...], Diagnosis]:
    """What was planted, the trials that have a mistake in the data, and what is said of it."""
    planted = drawn(Lot(system, kind, SEED, place))
    case = planted.case
    return planted.label.effects, planted.label.faulty, diagnose(case, system_of(case)).diagnosis


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
    truth, _, found = elsewhere(answered, system, kind, place)
    assert set(truth) == effects and found.verdict == "explained" and set(found.effects) == effects
    assert max(one.reduction for one in found.gap.values()) > 0.0 and found.where[0].p_value < 0.05


def test_sides_that_were_exchanged_are_found_with_their_trials(elsewhere: Elsewhere) -> None:
    truth, faulty, found = elsewhere(answered, "knee", "fault", 0)
    assert tuple(truth) == found.effects == ("side_swap",)
    (mistake,) = found.faults
    assert mistake.effect == "side_swap" and set(mistake.trials) == set(faulty)
