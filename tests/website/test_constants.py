"""The page of constants adds runs up, and says where one did not try."""

from __future__ import annotations

from website.constants import beside, effect, foot, said

MOVED = {"moved": ["a", "b"], "after": {"false_alarms": 1, "first_right": 2, "failed": 1}}
RUNS = [
    {
        "answers": 5,
        "before": {"false_alarms": 0, "first_right": 3, "failed": 0},
        "constants": {"SURE": {"value": 6.0, "times 2": MOVED}, "FEW": {"value": 20}},
    },
    {
        "answers": 6,
        "before": {"false_alarms": 1, "first_right": 4, "failed": 0},
        "constants": {"SURE": {"value": 6.0, "times 2": "moves nothing"}},
    },
]


def test_runs_are_added_up() -> None:
    told = effect(RUNS, "SURE", 6.0, "times 2")
    assert told == {"moved": 2, "of": 11, "false_alarms": 2, "first_right": 6, "failed": 1}
    assert said(told) == "2 of 11, 2, 6, 1"


def test_what_a_run_did_not_try_is_not_called_harmless() -> None:
    assert effect(RUNS, "SURE", 6.0, "times 0.5") is None and effect(RUNS, "FEW", 20, "times 2") is None
    assert effect(RUNS, "SURE", 5.0, "times 2") is None and effect(RUNS, "NEW", 5.0, "times 2") is None
    still = foot(
        [("FEW", 20, [None, effect(RUNS, "SURE", 6.0, "times 2")]), ("ODD", 5.0, [{"moved": 0}, {"moved": 0}])]
    )
    assert still == ["## 1 that move no answer", "`ODD` (5).", "## Not tried with every factor", "`FEW`."]


def test_failures_that_an_old_run_took_for_alarms_are_left_out() -> None:
    old = {"moved": ["a", "b"], "after": {"false_alarms": 2, "first_right": 0}}
    run = {
        "answers": 2,
        "before": {"false_alarms": 0, "first_right": 1},
        "constants": {"C": {"value": 4, "times 2": old}},
    }
    assert effect([run], "C", 4, "times 2") is None
    new = {"moved": ["a", "b"], "after": {"false_alarms": 0, "first_right": 0, "failed": 2}}
    told = effect([run | {"constants": {"C": {"value": 4, "times 2": new}}}], "C", 4, "times 2")
    assert told is not None and told["failed"] == 2


def test_what_works_on_a_verdict_is_told_by_what_it_moves() -> None:
    title, _, rows = beside(["gap.localise.gap_map.BINS", "gap.reduction.error_reduction.FORM"])
    assert title.startswith("## 2 ") and rows.splitlines()[0].endswith("`gap.localise.gap_map.BINS`.")
    assert beside([]) == []
