"""Constants of the diagnosis and what they move: docs/reference/gap_constants.md, from two benchmarks.

`benchmarks.gap_constants` has those that a verdict comes from, `benchmarks.gap_told_constants` all others.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from benchmarks.constants_of import constants as found_in
from benchmarks.gap_constants import ROOMS
from website.stage import ROOT

PAGE = "docs/reference/gap_constants.md"
RESULTS = "benchmarks/results/gap_constants_*.json"
TOLD = "benchmarks/results/gap_told_constants.json"
FACTORS = {"times 0.5": "halved", "times 2": "doubled"}
KINDS = {"false_alarms": "false alarms", "first_right": "first", "failed": "failed"}
Run = dict[str, Any]

DRAWN = ("seed", "systems", "kinds", "cases", "laboratories")
"""What cases are drawn by: runs that agree in it have the same ones."""
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
    runs = [json.loads(file.read_text(encoding="utf-8")) for file in sorted(ROOT.glob(RESULTS))]
    told = json.loads((ROOT / TOLD).read_text(encoding="utf-8"))
    judging = {one.label: one.value for one in found_in(ROOMS)}
    rows = [
        (label, value, [effect(runs, label, value, factor) for factor in FACTORS]) for label, value in judging.items()
    ]
    moving = [row for row in rows if any(one and one.moved for one in row[2])]
    moving.sort(key=lambda row: -sum(one.moved / one.of for one in row[2] if one))
    still = [row for row in rows if row not in moving]
    aside = {one.label: one.value for one in found_in(("gap", "identify")) if one.label not in judging}
    return "\n\n".join([*head(runs, len(judging)), table(moving), *foot(rows, still), *beside(told, aside)]) + "\n"


def head(runs: Sequence[Run], count: int) -> list[str]:
    """What was done, and what is true before anything is changed; `count` constants move a verdict."""
    whole = list({str([run[what] for what in DRAWN]): run for run in reversed(runs)}.values())
    cases, nothing = (sum(run[what] for run in whole) for what in ("answers", "nothing_missing"))
    alarms, first, failed = (sum(run["before"][kind] for run in whole) for kind in KINDS)
    calls = [
        f"`--seed {run['seed']} --systems {' '.join(run['systems'])} --cases {run['cases']}` at {run['commit']}"
        for run in runs
    ]
    unseen = 100.0 * (1.0 - 0.05 ** (1.0 / cases))
    what = (
        f"{count} numbers with a name stand in the rooms that a verdict comes from. They were halved, and doubled, and "
        "the same synthetic cases were diagnosed again (`python -m benchmarks.gap_constants`): "
        f"{cases} cases drawn at home, {nothing} of them without an effect. What each is and where it comes from: "
        f"[theory](../theory/gap_diagnosis.md#constants). Made by `python -m website.pages` from {'; '.join(calls)}."
    )
    before = (
        f"With the constants as they are: {alarms} false alarms in {nothing} cases, the right effect first in {first} "
        f"of {cases - nothing}, {failed} that failed. An answer is moved where its verdict or its first name is "
        "another one; nats are the mean change of the logarithm of the probability that is stated for the truth. "
        "Constants were tried in groups, and one by one where a group moved an answer: two that undo each "
        "other would be missed, and nats are told only of what was tried by itself. Where a number ends the diagnosis "
        "an answer counts as moved and as failed: neither as a false alarm nor as right. Not tried: tables of several "
        f"values, numbers without a name. A constant that moves none of {cases} answers may still move {unseen:.0f} % "
        "of all (95 %)."
    )
    return ["# Constants of the diagnosis, halved and doubled", what, before]


def table(rows: Sequence[tuple[str, float, list[Effect | None]]]) -> str:
    """Constants that move an answer: how many, and what becomes of false alarms and right names."""
    lines = ["| constant | value | " + " | ".join(FACTORS.values()) + " |", "|---|---|---|---|"]
    for label, value, effects in rows:
        lines.append(
            f"| `{label}` | {value:.4g} | " + " | ".join(one.words() if one else "not tried" for one in effects) + " |"
        )
    return "\n".join(lines)


def foot(
    rows: Sequence[tuple[str, float, list[Effect | None]]], still: Sequence[tuple[str, float, list[Effect | None]]]
) -> list[str]:
    """Constants that move none, by the cases that they were tried on, and what was not tried with a factor."""
    by_count: dict[int, list[str]] = {}
    for label, value, effects in still:
        tried = [one.of for one in effects if one]
        if len(tried) == len(FACTORS):
            by_count.setdefault(min(tried), []).append(f"`{label}` ({value:.4g})")
    parts = [f"## {sum(map(len, by_count.values()))} that move no answer"]
    parts += [f"In {count} cases: {', '.join(names)}." for count, names in sorted(by_count.items(), reverse=True)]
    left = [
        f"`{label}` ({', '.join(word for word, one in zip(FACTORS.values(), effects, strict=True) if not one)})"
        for label, _, effects in rows
        if not all(effects)
    ]
    return parts + (["## Not tried with every factor", ", ".join(left) + "."] if left else [])


def beside(told: Run, labels: dict[str, float]) -> list[str]:
    """Constants of rooms that work on a verdict that is there, by what they move."""
    trials = [row[factor] for row in told["constants"].values() for factor in FACTORS if row.get(factor)]
    judged = sum(any(part in VERDICT for part in one["parts"]) for one in trials)
    why = (
        "These rooms work on a verdict that is there: where a gap lies, how far it shrinks, what these trials would "
        f"not show, what to record next. {told['answers']} cases (`--seed {told['seed']}`, {told['commit']}) were "
        "attributed once, and what follows was worked out with each constant halved and doubled "
        "(`python -m benchmarks.gap_told_constants`). A verdict, its effects or their probabilities changed in "
        f"{judged} of {len(trials)} trials: false alarms and right names stay where that is 0. In how many cases "
        "another part changes, and which:"
    )
    lines = ["| constant | value | halved | doubled |", "|---|---|---|---|"]
    for label, value in labels.items():
        row = told["constants"].get(label, {})
        known = row.get("value") == value
        cells = [_parts(row.get(factor) if known else None, told["answers"]) for factor in FACTORS]
        lines.append(f"| `{label}` | {value:.4g} | {' | '.join(cells)} |")
    return [f"## {len(labels)} that can move no verdict", why, "\n".join(lines)] if labels else []


def _parts(one: dict[str, Any] | None, of: int) -> str:
    if one is None:
        return "not tried"
    return f"{one['moved']} of {of}" + "".join(f", {PARTS.get(part, part)}" for part in one["parts"])


def effect(runs: Sequence[Run], label: str, value: float, factor: str) -> Effect | None:
    """What a constant does with a factor, over the runs that had it at this value and came to it; None without any."""
    moved, of, nats, alone = 0, 0, 0.0, True
    before, after = dict.fromkeys(KINDS, 0), dict.fromkeys(KINDS, 0)
    for run in (run for run in runs if run["constants"].get(label, {}).get("value") == value):
        told = run["constants"][label].get(factor)
        if told is None:
            continue
        grouped = told == "moves nothing"
        new = run["before"] if grouped else told["after"]
        moved += 0 if grouped else len(told["moved"])
        of += run["answers"]
        alone = alone and not grouped
        if alone:
            nats += run["answers"] * (new["nats"] - run["before"]["nats"])
        for kind in KINDS:
            before[kind] += run["before"][kind]
            after[kind] += new[kind]
    if not of:
        return None
    known = nats / of if alone and nats == nats and abs(nats) != float("inf") else None
    return Effect(moved, of, tuple(before.values()), tuple(after.values()), known)
