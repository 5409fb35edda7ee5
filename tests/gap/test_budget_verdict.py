"""Which verdict follows from a budget, by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest

from geocontact.data.diagnosis import BudgetPart
from geocontact.gap.attribute import Attribution
from geocontact.gap.budget_verdict import amplitude_left, by_budget, closed, differ, named_beside, totals, with_gap
from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import LEFT_OVER, WORTH_NAMING
from geocontact.gap.reduction.error_budget import ChannelBudget
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.selection.verdict import Answer
from tests.gap.test_verdict import contender

ODDS = {"none": 0.5, "unknown": 0.2, "damping": 0.3}


def channel(effects: float, unexplained: float, missed: float) -> ChannelBudget:
    sizes = {"sensor": 1.0 - effects - unexplained, "inputs": 0.0, "variation": 0.0}
    sizes |= {"effects": effects, "unexplained": unexplained}
    return ChannelBudget({name: BudgetPart(size, (size, size)) for name, size in sizes.items()}, missed)


def given(verdict: str, *effects: str, stated: bool = True) -> tuple[Mock, Mock]:
    """An attribution of two channels, of which the second has a floor ten times as high, and errors of 10 and 10."""
    problem = Mock(spec=Problem)
    problem.calibration = SimpleNamespace(trials=("t1",))
    problem.system = SimpleNamespace(outputs=("force", "moment"))
    problem.floor = np.array([1.0, 10.0])
    found = Mock(spec=Attribution)
    found.problem, found.stated = problem, {"force": 1.0, "moment": 1.0} if stated else {"force": 1.0}
    chosen = contender(5.0, *effects) if effects else contender(0.0)
    found.data_error, found.base = None, contender(0.0)
    found.answer = Answer(verdict, effects, ODDS, effects, chosen)  # type: ignore[arg-type]
    errors = Mock(spec=RawInputErrors)
    errors.before = [np.full((1, 2), 99.0), np.full((1, 2), 10.0)]
    return found, errors


def verdict(found: Mock, errors: Mock, force: ChannelBudget, moment: ChannelBudget | None = None) -> Answer:
    return by_budget(found, {"force": force, "moment": moment or channel(0.0, 0.0, 0.0)}, errors)


def test_no_gap_that_surely_misses_a_tenth_is_unknown() -> None:
    found, errors = given("no_gap")
    assert verdict(found, errors, channel(0.0, 0.5, 0.99 * WORTH_NAMING)).verdict == "no_gap"
    said = verdict(found, errors, channel(0.0, 0.5, WORTH_NAMING))
    assert said.verdict == "unknown" and said.probabilities == {"unknown": 0.7, "damping": 0.3, "none": 0.0}
    assert verdict(found, errors, channel(0.0, 0.0, 0.0), channel(0.0, 0.5, 0.4)).verdict == "unknown"


def test_an_error_of_more_than_twice_its_floor_is_no_no_gap() -> None:
    """White noise of three times what is stated: 1/9 of its square is the floor, and nothing is surely missed."""
    found, errors = given("no_gap")
    assert verdict(found, errors, channel(0.0, 8.0 / 9.0, 0.0)).verdict == "unknown"
    assert verdict(found, errors, channel(0.0, 0.74, 0.0)).verdict == "no_gap"
    found, errors = given("explained", "damping")
    said = verdict(found, errors, channel(0.05, 0.8, 0.0))
    assert said.verdict == "unknown" and said.effects == ()


def test_a_gap_beside_no_gap_is_unknown_and_others_stay() -> None:
    found, _ = given("no_gap")
    said = with_gap(replace(found.answer, probabilities={"none": 0.6, "unknown": 0.1, "damping": 0.3}))
    assert said.verdict == "unknown" and said.probabilities == {"unknown": 0.7, "damping": 0.3, "none": 0.0}
    for verdict_of in ("explained", "unknown", "unresolved"):
        found, _ = given(verdict_of)
        assert with_gap(found.answer) is found.answer


def test_no_budget_closes_nothing() -> None:
    found, errors = given("unknown")
    assert not closed(found, {}) and by_budget(found, {}, errors).verdict == "unknown"


def test_unknown_whose_budget_closes_is_no_gap_where_all_noise_is_stated() -> None:
    found, errors = given("unknown")
    said = verdict(found, errors, channel(0.0, 0.09, 0.0))
    assert said.verdict == "no_gap" and next(iter(said.probabilities)) == "none"
    assert verdict(found, errors, channel(0.0, 0.11, 0.0)).verdict == "unknown"
    assert verdict(found, errors, channel(0.0, 0.09, 0.2)).verdict == "unknown"
    found, errors = given("unknown", stated=False)
    assert verdict(found, errors, channel(0.0, 0.09, 0.0)).verdict == "unknown"


def test_channels_count_in_units_of_their_floors() -> None:
    """Squares of 100 and 1: what the second channel misses beside the first makes no difference."""
    found, errors = given("explained", "damping")
    budget = {"force": channel(0.6, 0.2, 0.1), "moment": channel(0.0, 0.9, 0.9)}
    assert totals(budget, errors, found.problem) == pytest.approx((60.0, 10.0 + 0.9, 20.0 + 0.9))


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_explained_in_part_where_a_quarter_of_what_is_taken_is_missed(share: float) -> None:
    missed = share * 0.25 * 0.6
    assert (missed > LEFT_OVER * (0.6 + missed)) == (share > 1.0)
    said = verdict(*given("explained", "damping"), channel(0.6, 0.2, missed))
    assert said.verdict == ("partly_explained" if share > 1.0 else "explained") and said.effects == ("damping",)


def test_what_surely_takes_less_than_a_tenth_is_not_named() -> None:
    """It is no gap, or unknown where something is surely missed; nothing missed is never explained in part."""
    found, errors = given("explained", "damping")
    little = verdict(found, errors, channel(0.09, 0.0, 0.0))
    assert (little.verdict, little.effects, little.chosen) == ("no_gap", (), found.base)
    assert little.probabilities["damping"] == 0.0 and little.probabilities["none"] == 0.8
    assert verdict(found, errors, channel(0.09, 0.5, 0.4)).verdict == "unknown"
    assert verdict(found, errors, channel(0.11, 0.0, 0.0), channel(-0.2, 0.0, 0.0)).effects == ("damping",)


def test_a_channel_that_is_predicted_worse_leaves_a_part() -> None:
    """An effect that takes much of one channel and makes another worse, for sure and by a tenth, is not all of it."""
    found, errors = given("explained", "damping")
    force = channel(0.9, 0.0, 0.0)
    worse = channel(-0.6, 0.0, 0.0)
    assert verdict(found, errors, force, channel(-0.05, 0.0, 0.0)).verdict == "explained"
    assert verdict(found, errors, force, worse).verdict == "partly_explained"
    doubtful = worse.parts | {"effects": BudgetPart(-0.6, (-1.0, 0.1))}
    assert verdict(found, errors, force, ChannelBudget(doubtful, 0.0)).verdict == "explained"


def test_what_is_explained_in_part_takes_half_of_unknown() -> None:
    one = contender(50.0, "damping")
    unknown = Answer("unknown", (), ODDS, (), contender(0.0))
    said = named_beside(unknown, one, True)
    assert said.verdict == "partly_explained" and said.effects == ("damping",) and said.chosen is one
    assert said.probabilities == pytest.approx({"none": 0.5, "damping": 0.4, "unknown": 0.1})
    whole = named_beside(unknown, one, False)
    assert whole.verdict == "explained" and whole.effects == ("damping",)
    assert whole.probabilities == pytest.approx({"none": 0.5, "damping": 0.5, "unknown": 0.0})


def test_an_amplitude_that_grows_with_the_rate_is_another_effect() -> None:
    """Of a change m a residual of 0.3 m is left: 0.3. Play of 1 that damping fits in trials of the rates 1 and 2 is
    1 - b and 1 - 2 b of it.
    """
    rng = np.random.default_rng(3)
    moved = np.sin(np.linspace(0.0, 20.0, 400))[:, None]
    off, error = amplitude_left(0.3 * moved + 0.05 * rng.standard_normal(moved.shape), moved, float((moved**2).sum()))
    assert off == pytest.approx(0.3, abs=4.0 * error) and 0.0 < error < 0.02
    b = 0.6
    by_rate = [(1.0 - b * rate) / (b * rate) for rate in (1.0, 1.5, 2.0)]
    assert differ(by_rate, [0.02] * 3)
    assert not differ(by_rate, [2.0] * 3), "not beyond chance"
    assert not differ([0.05, -0.05, 0.02], [0.001] * 3), "too little to matter"
    assert not differ([0.7], [0.01])
