"""The page of constants adds runs up, and says where one did not try."""

from __future__ import annotations

from website.constants import effect, foot, said

MOVED = {"moved": ["a", "b"], "after": {"false_alarms": 1, "first_right": 2, "failed": 1}}
RUNS = [
    {
        "answers": 5,
        "before": {"false_alarms": 0, "first_right": 3, "failed": 0},
        "constants": {"SURE": {"times 2": MOVED}, "FEW": {}},
    },
    {
        "answers": 6,
        "before": {"false_alarms": 1, "first_right": 4, "failed": 0},
        "constants": {"SURE": {"times 2": "moves nothing"}},
    },
]


def test_runs_are_added_up() -> None:
    told = effect(RUNS, "SURE", "times 2")
    assert told == {"moved": 2, "of": 11, "false_alarms": 2, "first_right": 6, "failed": 1}
    assert said(told) == "2 of 11, 2, 6, 1"


def test_what_a_run_did_not_try_is_not_called_harmless() -> None:
    assert effect(RUNS, "SURE", "times 0.5") is None and effect(RUNS, "FEW", "times 2") is None
    still = foot([("FEW", 20, [None, effect(RUNS, "SURE", "times 2")]), ("ODD", 5.0, [{"moved": 0}, {"moved": 0}])])
    assert still == ["## 1 that move no answer", "`ODD` (5).", "## Not tried with every factor", "`FEW`."]
