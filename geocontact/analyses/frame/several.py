"""What the parts of a study say beside their numbers: warnings by kind, and which of them contradict their data."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from geocontact.analyses.frame.collector import judge, reserve
from geocontact.analyses.frame.warning_kinds import first_of_each_kind, merged
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit

CONTRADICTS, DOUBTFUL = "contradicts", "doubtful"
NAMED = 3
"""Parts that a sentence names; their table has them all."""


def reserve_of_several(parts: Iterable[tuple[str, Sequence[str]]], noun: str = "trial") -> None:
    """The first warning of each kind, with its part and the count of others that have it; `parts` are names with
    warnings.
    """
    for line in first_of_each_kind(parts, noun):
        reserve(line)


def judge_several(parts: Iterable[tuple[str, str]], remedy: str, noun: str = "trial") -> None:
    """Whether the parts agree with their data; nothing where none was compared.

    Parameters
    ----------
    parts
        Names with the outcome of the fit of each; "" where nothing was compared.
    remedy
        What to do with those that contradict their data.
    noun
        What they are.
    """
    tested = [(name, outcome) for name, outcome in parts if outcome]
    if not tested:
        return
    doubts = []
    for outcome, what in ((CONTRADICTS, "contradict their data"), (DOUBTFUL, "fit their data doubtfully")):
        names = [name for name, found in tested if found == outcome]
        if not names:
            continue
        more = f" and {len(names) - NAMED} others" if len(names) > NAMED else ""
        line = f"{len(names)} of {len(tested)} {noun}s {what}: {', '.join(names[:NAMED])}{more}"
        share = len(names) / len(tested)
        doubts.append(Doubt(line, outcome == CONTRADICTS and share >= MUCH, share))
        if outcome == CONTRADICTS:
            reserve(f"{line}; {remedy}")
    judge(GoodnessOfFit(tuple(doubts), tuple(name for name, _ in tested)), warned=True)


def doubt_columns(outcome: str, warnings: Sequence[str]) -> dict[str, str | int]:
    """Columns of a table of parts: outcome of the fit, count of warnings, and each kind of them in words."""
    return {"fit": outcome, "warnings [-]": len(warnings), "warnings": "; ".join(merged(warnings))}
