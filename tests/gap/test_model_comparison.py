"""Pairs of effects are searched for under quiet noise, each two effects once; what cannot lead is left early."""

from __future__ import annotations

import pytest

from tests.elsewhere import Elsewhere
from tests.gap.cases import contest_work, finished_twice, paired


def test_two_effects_are_found_and_each_two_are_tried_once(elsewhere: Elsewhere) -> None:
    names, gains, again, costs, simulated = elsewhere(paired)
    assert names == [("damping", "sensor_drift"), ("damping", "end_stop")]
    assert gains[0] > 30.0
    assert gains[0] > gains[1] + 20.0
    assert again[0] == pytest.approx(gains[0], abs=0.05)
    assert costs[0].keys() == costs[1].keys()
    for label, cost in costs[0].items():
        assert costs[1][label] < cost + 0.05, "a search that was left early may get further"
    assert simulated[1] < 0.7 * simulated[0]


@pytest.mark.slow
def test_what_cannot_lead_is_left_early_and_the_leaders_stay(elsewhere: Elsewhere) -> None:
    singles, pairs, simulated, simulated_for_pairs = elsewhere(contest_work, cut=True)
    all_singles, all_pairs, at_most, at_most_for_pairs = elsewhere(contest_work, cut=False)
    assert (singles, pairs) == (all_singles, all_pairs)
    assert simulated < 0.7 * at_most
    assert simulated_for_pairs < at_most_for_pairs


@pytest.mark.parametrize("later", [False, True])
def test_who_leads_under_quiet_noise_and_under_its_own_is_finished_from_both_fits(
    elsewhere: Elsewhere, later: bool
) -> None:
    """Noise that suits another fit may lead away from a good one: the better of the two ends is kept."""
    found = elsewhere(finished_twice, later_is_better=later)
    assert sum(len(each) == 2 for each, _ in found.values()) >= 3
    for each, kept in found.values():
        assert kept == max(each)
