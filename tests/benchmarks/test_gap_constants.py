"""Constants in question: found where they stand, put where they are used, and counted for what they move."""

from __future__ import annotations

from benchmarks.constants_of import constants, put
from benchmarks.gap_constants import figures, searched
from geocontact.gap import partial_answer
from geocontact.gap.selection import clipping, verdict


def test_a_number_is_another_one_wherever_it_was_imported() -> None:
    found = {one.label: one for one in constants(["gap.selection", "gap.case"])}
    sure = found["gap.selection.verdict.SURE"]
    assert sure.value == verdict.SURE and "gap.selection.clipping.NEXT" in found
    assert found["gap.case.problem.USUALLY"].value == 4.0  # one of two that a line names
    assert "gap.selection.surrogate.ALONG" not in found  # a table, no number
    before, other = sure.value, clipping.SURE_OF_IT
    try:
        put({sure: sure.times(2.0)})
        used = [verdict.SURE, partial_answer.SURE, clipping.SURE_OF_IT]
        assert used == [2.0 * before, 2.0 * before, other]
    finally:
        put({sure: before})
    assert used[0] != partial_answer.SURE
    assert found["gap.selection.clipping.NEXT"].times(0.01) == 1


def test_answers_are_counted_by_what_they_were_and_are() -> None:
    quiet = {"verdict": "no_gap", "first": "", "truth": []}
    right = {"verdict": "explained", "first": "damping", "truth": ["damping"]}
    alarm = {"verdict": "unknown", "first": "slip", "truth": []}
    told = figures({"a": quiet, "b": right}, {"a": alarm})
    assert told["moved"] == ["a", "b"]
    assert told["before"] == {"false_alarms": 0, "first_right": 1}
    assert told["after"] == {"false_alarms": 1, "first_right": 0}


def test_a_group_is_halved_down_to_what_moves_an_answer() -> None:
    named, asked = constants(["gap.selection.verdict"]), []

    def tried(group: list, factor: float) -> dict:
        asked.append([one.name for one in group])
        return {"moved": ["a"] if any(one.name == "FORM" for one in group) else []}

    searched(named, 2.0, tried)
    assert [names for names in asked if len(names) == 1] == [["SURE"], ["FORM"]] and len(asked) < len(named)
