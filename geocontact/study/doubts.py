"""What the trials of a study say beside their numbers: warnings, and whether they agree with their data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from geocontact.analyses.frame.collector import judge, reserve
from geocontact.analyses.frame.warning_kinds import first_of_each_kind, merged
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit

CONTRADICTS = "contradicts"
NAMED = 3
"""Trials that a sentence names; trials.csv has them all."""
LEAVE_OUT = "look at them, mend or leave them out with `[[leave_out]]`"


def reserve_of_trials(told: Iterable[tuple[str, Mapping[str, Any]]]) -> None:
    """The first warning of each kind with its trial and the count of others; trials.csv has those of every trial."""
    for line in first_of_each_kind([(name, each["warnings"]) for name, each in told]):
        reserve(line)


def judge_trials(told: Sequence[tuple[str, Mapping[str, Any]]]) -> None:
    """Whether the trials agree with their data; nothing where none was compared."""
    tested = [(name, str(each.get("fit", ""))) for name, each in told if each.get("fit")]
    if not tested:
        return
    doubts = []
    for outcome, what in ((CONTRADICTS, "contradict their data"), ("doubtful", "fit their data doubtfully")):
        names = [name for name, found in tested if found == outcome]
        if not names:
            continue
        more = f" and {len(names) - NAMED} others" if len(names) > NAMED else ""
        line = f"{len(names)} of {len(tested)} trials {what}: {', '.join(names[:NAMED])}{more}"
        share = len(names) / len(tested)
        doubts.append(Doubt(line, outcome == CONTRADICTS and share >= MUCH, share))
        if outcome == CONTRADICTS:
            reserve(f"{line}; their numbers are in tables and means: {LEAVE_OUT}")
    judge(GoodnessOfFit(tuple(doubts), tuple(name for name, _ in tested)), warned=True)


def doubt_columns(told: Mapping[str, Any]) -> dict[str, object]:
    """Columns of trials.csv: whether the result fits, how many warnings there are, and each kind of them in words."""
    lines = [str(line) for line in told.get("warnings", ())]
    return {"fit": str(told.get("fit", "")), "warnings [-]": len(lines), "warnings": "; ".join(merged(lines))}
