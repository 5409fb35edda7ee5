"""The page of constants adds runs up, and says where one did not try."""

from __future__ import annotations

import pytest

from website.constants import Effect, beside, effect, foot, same, shown, table

BEFORE = {"false_alarms": 0, "first_right": 3, "failed": 0, "nats": -0.25}
MOVED = {
    "moved": ["a", "b"],
    "before": BEFORE,
    "after": {"false_alarms": 1, "first_right": 2, "failed": 1, "nats": -0.5},
}
RUNS = [
    {
        "seed": 1,
        "answers": 5,
        "before": BEFORE,
        "constants": {"SURE": {"value": 6.0, "times 2": MOVED}, "FEW": {"value": 20}},
    },
    {"seed": 2, "answers": 6, "before": BEFORE, "constants": {"SURE": {"value": 6.0, "times 2": "moves nothing"}}},
]


def test_runs_are_added_up() -> None:
    told = effect(RUNS, "SURE", 6.0, "times 2")
    assert told == Effect(2, 11, (0, 6, 0), (1, 5, 1), None)
    assert told.words() == "2 of 11, false alarms 0 → 1, first 6 → 5, failed 0 → 1"


def test_nats_are_told_of_what_was_tried_by_itself() -> None:
    told = effect(RUNS[:1], "SURE", 6.0, "times 2")
    assert told is not None and told.nats == pytest.approx(-0.25)
    assert told.words().endswith("failed 0 → 1, -0.25 nats")


def test_runs_on_the_same_cases_count_once() -> None:
    again = {**RUNS[0], "constants": {"SURE": {"value": 6.0, "times 2": "moves nothing"}}}
    told = effect([RUNS[0], again], "SURE", 6.0, "times 2")
    assert told == Effect(0, 5, (0, 3, 0), (0, 3, 0), None)
    untried = {**RUNS[0], "constants": {"SURE": {"value": 6.0}}}
    assert effect([RUNS[0], untried], "SURE", 6.0, "times 2") == effect(RUNS[:1], "SURE", 6.0, "times 2")


def test_nothing_answered_has_no_nats() -> None:
    ended = {**MOVED, "after": {"false_alarms": 0, "first_right": 0, "failed": 5, "nats": None}}
    told = effect([{**RUNS[0], "constants": {"CYCLES": {"value": 4, "times 2": ended}}}], "CYCLES", 4, "times 2")
    assert told is not None and told.nats is None and told.after[2] == 5


def test_what_a_run_did_not_try_is_not_called_harmless() -> None:
    assert effect(RUNS, "SURE", 6.0, "times 0.5") is None and effect(RUNS, "FEW", 20, "times 2") is None
    assert effect(RUNS, "SURE", 5.0, "times 2") is None and effect(RUNS, "NEW", 5.0, "times 2") is None
    none = Effect(0, 4, (0, 1, 0), (0, 1, 0), None)
    rows = [("FEW", 20, [None, none]), ("ODD", 5.0, [none, none])]
    assert foot(rows, rows) == [
        "## 1 that move no answer",
        "1 in 4 cases (so they move up to 53 % of all, 95 %).",
        "## Not tried with every factor",
        "`FEW` (halved).",
    ]
    assert table([("FEW", 20, [None, none])]).splitlines()[-1] == "| `FEW` | 20 | not tried | 0 of 4 |"


def test_a_table_is_known_by_all_its_values() -> None:
    pairs = ((0.08, 0.7), (0.2, 0.7))
    run = {**RUNS[0], "constants": {"BROAD": {"value": [[0.08, 0.7], [0.2, 0.7]], "times 2": MOVED}}}
    told = effect([run], "BROAD", pairs, "times 2")
    assert told is not None and effect([run], "BROAD", ((0.08, 0.7), (0.3, 0.7)), "times 2") is None
    assert table([("BROAD", pairs, [None, told])]).splitlines()[-1].startswith("| `BROAD` | 0.08, 0.7, 0.2, 0.7 | not")
    assert shown((0.0, 5.0, float("inf"))) == "0, 5, inf" and same((0.0, float("inf")), [0.0, None])


def test_what_works_on_a_verdict_is_told_by_what_it_moves() -> None:
    row = {"value": 6, "times 0.5": {"moved": 2, "parts": {"map": 1.0, "where": 0.2}, "inside": [1, 4]}}
    told = {"answers": 10, "seed": 1, "commit": "abc", "inside": [2, 4], "constants": {"BINS": row, "GRID": row}}
    title, said, rows = beside(told, {"BINS": 6, "GRID": 101})
    assert title == "## 2 that can move no verdict"
    assert (
        "in 0 of 2 trials" in said
        and "4 true reductions" in said
        and "others change nothing" not in said
        and "1 with a constant changed" in said
    )
    assert rows.splitlines() == [
        "- the map of the gap, where the gap lies: `BINS` (2, not tried)",
        "- not known: `GRID` (not tried, not tried)",
    ]
    assert beside(told, {}) == []


def test_what_moves_nothing_is_listed_without_a_row() -> None:
    still = {"moved": 0, "parts": {}, "inside": [2, 4]}
    rows = {"EVEN": {"value": 2, "times 0.5": still, "times 2": still}}
    told = {"answers": 10, "seed": 1, "commit": "abc", "inside": [2, 4], "constants": rows}
    _, said, items = beside(told, {"EVEN": 2})
    assert said.endswith(" 1 others change nothing.") and items == ""
