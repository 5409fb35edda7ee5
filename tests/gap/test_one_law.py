"""Effects that are one law on the trials of a case, and effects that are not."""

from __future__ import annotations

import pytest

from geocontact.gap.levels import APART
from tests.elsewhere import Elsewhere
from tests.gap.identifiability_cases import laws_of_pair, laws_of_play_and_delay, laws_of_slow_delay

pytestmark = pytest.mark.slow


def test_what_moves_slowly_is_as_late_by_a_delay_as_by_a_filter_and_no_damper(elsewhere: Elsewhere) -> None:
    named, unresolved, nothing, unknown = elsewhere(laws_of_slow_delay)
    assert named.classes == (("time_shift", "filter_lag"),)
    assert named.apart["filter_lag"] < APART < named.apart["damping"]
    assert unresolved == named, "where too many remain the class is that of the likeliest"
    for each in (nothing, unknown):
        assert (each.classes, dict(each.apart)) == ((), {}), "where nothing is named there is no class"


def test_of_two_effects_each_has_a_class_of_its_own(elsewhere: Elsewhere) -> None:
    """A delay beside a drift may be a filter; nothing else takes the place of the drift."""
    found = elsewhere(laws_of_pair)
    assert found.classes == (("time_shift", "filter_lag"),)
    assert found.apart["filter_lag"] < APART


def test_of_a_play_and_a_delay_the_delay_may_be_a_filter_whatever_else_that_is_probable_beside(
    elsewhere: Elsewhere,
) -> None:
    for found in elsewhere(laws_of_play_and_delay):
        assert found.classes == (("time_shift", "filter_lag"),)
        assert found.apart["filter_lag"] < APART
