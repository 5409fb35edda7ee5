"""Constants of the diagnosis and what they move: docs/reference/gap_constants.md, from two benchmarks.

`benchmarks.gap.constants` has those that a verdict comes from, `benchmarks.gap.later_constants` all others.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from benchmarks.gap.constants import DRAWN, ROOMS, choices
from benchmarks.gap.constants_of import Value, numbers_in
from benchmarks.machine import as_json
from website.stage import ROOT

PAGE = "docs/reference/gap_constants.md"
RESULTS = "benchmarks/results/gap_constants_*.json"
TOLD = "benchmarks/results/gap_told_constants.json"
FACTORS = {"times 0.5": "halved", "times 2": "doubled"}
KINDS = {"false_alarms": "false alarms", "first_right": "first", "failed": "failed"}
Run = dict[str, Any]

PARTS = {
    "map": "the map of the gap",
    "where": "where the gap lies",
    "gap": "errors, reductions and intervals",
    "absorbed": "effects that would be absorbed",
    "parameters": "which parameters are identifiable",
    "next_experiment": "the next experiment",
    "failed": "the diagnosis ends",
}
"""Parts of a diagnosis in words."""
VERDICT = ("verdict", "effects", "probabilities", "ambiguity")
"""Parts that an answer is made of."""


@dataclass(frozen=True)
class Effect:
    """What a changed constant does, over all runs that tried it with this factor.

    Parameters
    ----------
    moved, of
        Answers that are other ones, of so many.
    before, after
        False alarms, right ones first, failures, in the order of `KINDS`.
    nats
        Mean change of the logarithm of the probability stated for the truth; None where it was not tried by itself.
    """

    moved: int
    of: int
    before: tuple[int, ...]
    after: tuple[int, ...]
    nats: float | None

    def words(self) -> str:
        """As a cell of the table has it: what changes."""
        changes = [
            f"{word} {one} → {other}"
            for word, one, other in zip(KINDS.values(), self.before, self.after, strict=True)
            if one != other
        ]
        nats = [f"{self.nats:+.2f} nats"] if self.nats is not None and abs(self.nats) >= 0.005 else []
        return f"{self.moved} of {self.of}" + "".join(f", {each}" for each in [*changes, *nats])


def constants() -> str:
    """The whole page; the runs' cases are added up."""
    runs = [json.loads(file.read_text(encoding="utf-8")) for file in ROOT.glob(RESULTS)]
    runs.sort(key=lambda run: str(run["date"]))
    told = json.loads((ROOT / TOLD).read_text(encoding="utf-8"))
    judging = {one.label: one.value for one in choices(ROOMS)}
    rows = [
        (label, value, [effect(runs, label, value, factor) for factor in FACTORS]) for label, value in judging.items()
    ]
    moving = [row for row in rows if any(one and one.moved for one in row[2])]
    moving.sort(key=lambda row: -sum(one.moved / one.of for one in row[2] if one))
    still = [row for row in rows if row not in moving]
    aside = {one.label: one.value for one in choices(("gap", "identify")) if one.label not in judging}
    numbers = sum(not isinstance(value, tuple) for value in judging.values())
    return (
        "\n\n".join(
            [
                *head(runs, numbers, len(judging) - numbers),
                table([row for row in moving if moves(row[2]) > 1]),
                once([row[0] for row in moving if moves(row[2]) == 1]),
                *foot(rows, still),
                *beside(told, aside),
            ]
        )
        + "\n"
    )


def head(runs: Sequence[Run], numbers: int, tables: int) -> list[str]:
    """What was done, and what is true before anything is changed; so many numbers and tables can move a verdict."""
    whole = {_cases(run): run for run in runs}.values()
    cases, nothing = (sum(run[what] for run in whole) for what in ("answers", "nothing_missing"))
    what = (
        f"{numbers} named numbers and {tables} tables of values decide a verdict. Each was halved and doubled (all "
        "values of a table; a count to one at least), and the same synthetic cases were diagnosed again "
        f"(`python -m benchmarks.gap.constants`): {cases} cases at home, {nothing} without an effect. What each is and "
        "where it comes from: [gap_constants.csv](gap_constants.csv); symbols: "
        "[theory](../theory/gap_diagnosis.md#constants)."
    )
    how = (
        "An answer is moved if its verdict or first name changes; nats are the mean change of the log probability of "
        "the truth. Constants were tried in groups, and one by one where a group moved an answer: two that cancel each "
        "other would be missed. Logarithms (SLOWEST, BROADEST, FLATTEST, STEEPEST) are halved and doubled as such."
    )
    before = "Unchanged (made by `python -m website.pages` from these runs):"
    lines = ["| run | commits | false alarms | right effect first | failed |", "|---|---|---|---|---|"]
    rows: dict[tuple[str, str], list[str]] = {}
    for run in runs:
        call = f"`--seed {run['seed']} --systems {' '.join(run['systems'])} --cases {run['cases']}`"
        alarms, first, failed = (run["before"][kind] for kind in KINDS)
        missing = run["answers"] - run["nothing_missing"]
        told = f"{alarms} of {run['nothing_missing']} | {first} of {missing} | {failed} of {run['answers']}"
        rows.setdefault((call, told), []).append(str(run["commit"]))
    lines += [f"| {call} | {', '.join(dict.fromkeys(those))} | {told} |" for (call, told), those in rows.items()]
    return ["# Constants of the diagnosis, halved and doubled", what, how, before, "\n".join(lines)]


def shown(value: Value) -> str:
    """A number, or those of a table."""
    return ", ".join(f"{each:.4g}" for each in numbers_in(value))


def same(value: Value, stored: Value) -> bool:
    """Whether a file of results has this value."""
    return bool(json.loads(as_json(value)) == stored)


def table(rows: Sequence[tuple[str, Value, list[Effect | None]]]) -> str:
    """Constants that move answers: how many, and what becomes of false alarms and right names."""
    lines = ["| constant | value | " + " | ".join(FACTORS.values()) + " |", "|---|---|---|---|"]
    for label, value, effects in rows:
        lines.append(
            f"| `{label}` | {shown(value)} | "
            + " | ".join(one.words() if one else "not tried" for one in effects)
            + " |"
        )
    return "\n".join(lines)


def moves(effects: Sequence[Effect | None]) -> int:
    """Answers that are other ones, over all factors."""
    return sum(one.moved for one in effects if one)


def once(labels: Sequence[str]) -> str:
    """Constants that move a single answer, with one factor."""
    return f"{len(labels)} move one answer, with one factor: {', '.join(f'`{one}`' for one in labels)}."


def foot(
    rows: Sequence[tuple[str, Value, list[Effect | None]]], still: Sequence[tuple[str, Value, list[Effect | None]]]
) -> list[str]:
    """How many move none, by the cases that they were tried on, and what was not tried with a factor."""
    by_count: dict[int, int] = {}
    for _, __, effects in still:
        tried = [one.of for one in effects if one]
        if len(tried) == len(FACTORS):
            by_count[min(tried)] = by_count.get(min(tried), 0) + 1
    parts = [f"## {sum(by_count.values())} that move no answer"]
    parts += [
        f"{number} in {count} cases (so they move up to {100.0 * (1.0 - 0.05 ** (1.0 / count)):.0f} % of all, 95 %)."
        for count, number in sorted(by_count.items(), reverse=True)
    ]
    left = [
        f"`{label}` ({', '.join(word for word, one in zip(FACTORS.values(), effects, strict=True) if not one)})"
        for label, _, effects in rows
        if not all(effects)
    ]
    return parts + (["## Not tried with every factor", ", ".join(left) + "."] if left else [])


def beside(told: Run, labels: dict[str, Value]) -> list[str]:
    """Constants of rooms that work on a verdict that is there, by what they move."""
    trials = [row[factor] for row in told["constants"].values() for factor in FACTORS if row.get(factor)]
    judged = sum(any(part in VERDICT for part in one["parts"]) for one in trials)
    why = (
        "These work on a finished verdict: where a gap lies, how far it shrinks, what these trials cannot show, what "
        f"to record next. {told['answers']} cases (`--seed {told['seed']}`, {told['commit']}) were diagnosed once, "
        "then each constant was halved and doubled (`python -m benchmarks.gap.later_constants`). A verdict, its "
        f"effects or probabilities changed in {judged} of {len(trials)} trials. In brackets the cases in which another "
        "part changes, halved and doubled. "
        f"Of {told['inside'][1]} true reductions {told['inside'][0]} lie inside their intervals, "
        f"{' to '.join(sorted({str(one['inside'][0]) for one in trials}))} with a constant changed."
    )
    by_parts: dict[str, list[str]] = {}
    still = 0
    for label, value in labels.items():
        row = told["constants"].get(label, {})
        known = same(value, row.get("value"))
        tried = [row.get(factor) if known else None for factor in FACTORS]
        if all(one and not one["moved"] for one in tried):
            still += 1
            continue
        parts = dict.fromkeys(PARTS.get(part, part) for one in tried if one for part in one["parts"])
        counts = ", ".join("not tried" if one is None else str(one["moved"]) for one in tried)
        by_parts.setdefault(", ".join(parts) or "not known", []).append(f"`{label}` ({counts})")
    if still:
        why += f" {still} others change nothing."
    lines = [f"- {parts}: {', '.join(those)}" for parts, those in by_parts.items()]
    return [f"## {len(labels)} that can move no verdict", why, "\n".join(lines)] if labels else []


def effect(runs: Sequence[Run], label: str, value: Value, factor: str) -> Effect | None:
    """What a constant does with a factor, over the runs that had it at this value and came to it; None without any.

    Of runs on the same cases the last one that tried it counts.
    """
    tried = {
        _cases(run): (run, run["constants"][label][factor])
        for run in runs
        if factor in run["constants"].get(label, {}) and same(value, run["constants"][label]["value"])
    }
    if not tried:
        return None
    told = [(run, None if what == "moves nothing" else what) for run, what in tried.values()]
    moved, of = sum(len(what["moved"]) for _, what in told if what), sum(run["answers"] for run, _ in told)
    before, after = (
        tuple(sum((what[when] if what else run["before"])[kind] for run, what in told) for kind in KINDS)
        for when in ("before", "after")
    )
    nats = [_nats(run, what) for run, what in told]
    known = None if None in nats else sum(one for one in nats if one is not None) / of
    return Effect(moved, of, before, after, known)


def _cases(run: Run) -> str:
    return str([run.get(what) for what in DRAWN])


def _nats(run: Run, what: Run | None) -> float | None:
    """Change over all answers of a run; None where the constant was not tried by itself, or nothing was answered."""
    if what is None or what["after"]["nats"] is None:
        return None
    return float(run["answers"] * (what["after"]["nats"] - what["before"]["nats"]))
