"""A proposal between two answers in question is simulated and refitted by the benchmark."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.gap.next_experiment import NOTHING, TIMES, in_question, separated
from geocontact.gap.experiment.proposal import proposed
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import elbow_case

ALIKE = ("time_shift", "filter_lag")


def tried(delay: float) -> tuple[tuple[str, ...], tuple[float, float] | None]:
    """What is in question of a delay [s], and separation on the old trials and with the proposed ones."""
    case = elbow_case("time_shift", {"time_shift.delay": delay}, seed=1)
    found = in_question(case, system_of(case), ALIKE)
    chosen = proposed(found, []) if len(found.answer.ambiguity) > 1 else None
    told = None if chosen is None else separated(found, chosen, np.random.default_rng(0), 1)
    return found.answer.ambiguity, told


@pytest.mark.slow
def test_a_delay_and_a_filter_are_told_apart_by_what_is_proposed(elsewhere: Elsewhere) -> None:
    ambiguity, told = elsewhere(tried, 0.02)
    assert set(ambiguity) == set(ALIKE)
    assert told is not None
    before, after = told
    assert after > TIMES * max(before, NOTHING)


@pytest.mark.slow
def test_of_a_long_delay_only_one_is_in_question(elsewhere: Elsewhere) -> None:
    ambiguity, told = elsewhere(tried, 0.12)
    assert ambiguity == ("time_shift",)
    assert told is None
