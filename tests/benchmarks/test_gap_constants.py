"""Constants in question: found where they stand, put where they are used, and counted for what they move."""

from __future__ import annotations

import ast
import inspect

import pytest

from benchmarks import gap_constants
from benchmarks.constants_of import _numbers, bare, constants, in_use, put
from benchmarks.gap_constants import ROOMS, figures, searched
from geocontact.gap import levels, partial_answer
from geocontact.gap.case import plain_fit, refit
from geocontact.gap.selection import clipping, verdict
from geocontact.gap_benchmark.drawing import Lot, drawn
from tests.house.test_gap_theory import ROWS

WHOLE = ("gap", "identify")


def test_a_number_is_another_one_wherever_it_was_imported() -> None:
    found = {one.label: one for one in constants(ROOMS)}
    sure = found["gap.levels.SURE"]
    assert sure.value == levels.SURE and "gap.selection.clipping.NEXT" in found
    assert found["identify.optimise.tolerances.BROKEN"].value == 0.25  # one of two that a line names
    assert "gap.selection.surrogate.ALONG" not in found  # a table, no number
    before, other = sure.value, clipping.NEXT
    try:
        put({sure: sure.times(2.0)})
        used = [levels.SURE, partial_answer.SURE, verdict.SURE, clipping.NEXT]
        assert used == [*[2.0 * before] * 3, other]
    finally:
        put({sure: before})
    assert used[0] != partial_answer.SURE
    assert found["gap.selection.clipping.NEXT"].times(0.01) == 1


def test_a_default_of_an_argument_is_another_one_too() -> None:
    rounds = next(one for one in constants(ROOMS) if one.label == "gap.case.refit.ROUNDS")

    def told() -> list[int]:
        return [inspect.signature(each).parameters["rounds"].default for each in (refit.refit, plain_fit.plain_fit)]

    before = told()
    try:
        put({rounds: rounds.times(0.5)})
        after = told()
    finally:
        put({rounds: rounds.value})
    assert before == told() == [rounds.value // 2, rounds.value]
    assert after == [rounds.value // 4, rounds.value // 2]


def test_answers_are_counted_by_what_they_were_and_are() -> None:
    quiet = {"verdict": "no_gap", "first": "", "truth": []}
    right = {"verdict": "explained", "first": "damping", "truth": ["damping"]}
    alarm = {"verdict": "unknown", "first": "slip", "truth": []}
    told = figures({"a": quiet, "b": right}, {"a": alarm, "b": quiet | {"truth": ["damping"]}})
    assert told["moved"] == ["a", "b"]
    assert told["before"] == {"false_alarms": 0, "first_right": 1, "failed": 0}
    assert told["after"] == {"false_alarms": 1, "first_right": 0, "failed": 0}


def test_a_diagnosis_that_fails_is_no_false_alarm(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(lot: Lot) -> dict:
        raise ValueError(lot.kind)

    class Sent:
        told: gap_constants.Answers

        def send(self, told: gap_constants.Answers) -> None:
            self.told = told

    monkeypatch.setattr(gap_constants, "attributed", broken)
    some, sent = [Lot("elbow", kind, 352612, 0) for kind in ("none", "single")], Sent()
    gap_constants.answers(some, {}, sent)
    planted = list(drawn(some[1]).label.effects)
    assert planted and [one["truth"] for one in sent.told.values()] == [[], planted]
    right = {name: {**one, "verdict": "no_gap", "first": (*one["truth"], "")[0]} for name, one in sent.told.items()}
    told = figures(right, sent.told)
    assert told["before"] == {"false_alarms": 0, "first_right": 1, "failed": 0}
    assert told["after"] == {"false_alarms": 0, "first_right": 0, "failed": 2} and len(told["moved"]) == 2
    assert figures(right, {})["after"] == told["after"]  # a process that was killed has told nothing


def test_a_group_is_halved_down_to_what_moves_an_answer() -> None:
    named, asked = constants(["gap.levels"])[:10], []

    def tried(group: list, factor: float) -> dict:
        asked.append([one.name for one in group])
        return {"moved": ["a"] if any(one.name == "SLIGHT" for one in group) else []}

    searched(named, 2.0, tried)
    assert [names for names in asked if len(names) == 1] == [["SLIGHT"]] and len(asked) < len(named)


def test_choices_do_not_become_more_again() -> None:
    """Of a verdict, and of all that a diagnosis imports of gap and identify."""
    assert len(constants(ROOMS)) <= 90
    assert len(bare(ROOMS)) <= 12
    assert len(constants(WHOLE)) <= 126
    assert len(bare(WHOLE)) <= 17


def test_every_constant_of_a_diagnosis_has_a_row() -> None:
    rows = {f"{module}.{name}" for module, name, _ in ROWS}
    assert {one.label for one in constants(WHOLE)} <= rows


def test_modules_that_no_diagnosis_imports_have_no_constants_of_it() -> None:
    used = in_use()
    assert {"geocontact.gap.selection.verdict", "geocontact.identify.noise.covariance"} <= used
    assert "geocontact.identify.noise.autocorrelation" not in used and not constants(["identify.noise.autocorrelation"])


def test_places_of_a_sequence_are_no_choices() -> None:
    function = ast.parse("def f(x):\n    return x[3] + x[:, 4] + 7.0 * x[5 * x[6]:, 0]").body[0]
    assert isinstance(function, ast.FunctionDef)
    assert sorted(_numbers(function)) == [5, 7.0]
