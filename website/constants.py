"""Constants of the diagnosis and what they move: docs/reference/gap_constants.md, from `benchmarks.gap_constants`."""

from __future__ import annotations

import json
from typing import Any

from website.stage import ROOT

PAGE = "docs/reference/gap_constants.md"
RESULTS = "benchmarks/results/gap_constants*.json"
FACTORS = {"times 0.5": "halved", "times 2": "doubled"}
KINDS = ("false_alarms", "first_right", "failed")


def constants() -> str:
    """The whole page; the runs' cases are added up."""
    runs = [json.loads(file.read_text(encoding="utf-8")) for file in sorted(ROOT.glob(RESULTS))]
    named: dict[str, float] = {label: one["value"] for run in runs for label, one in run["constants"].items()}
    rows = [(label, value, [effect(runs, label, factor) for factor in FACTORS]) for label, value in named.items()]
    moving = sorted((row for row in rows if any(map(moved, row[2]))), key=lambda row: -sum(map(moved, row[2])))
    still = [row for row in rows if not any(map(moved, row[2]))]
    return "\n\n".join([*head(runs), table(moving), *foot(still)]) + "\n"


def head(runs: list[dict[str, Any]]) -> list[str]:
    """What was done, and what is true before anything is changed."""
    most = max(len(run["constants"]) for run in runs)
    whole = [run for run in runs if len(run["constants"]) == most]  # others are of single constants
    cases, nothing = (sum(run[what] for run in whole) for what in ("answers", "nothing_missing"))
    alarms, first, failed = (sum(run["before"].get(kind, 0) for run in whole) for kind in KINDS)
    calls = [
        f"`--seed {run['seed']} --systems {' '.join(run['systems'])} --cases {run['cases']}` at {run['commit']}"
        for run in runs
    ]
    unseen = 100.0 * (1.0 - 0.05 ** (1.0 / cases))
    what = (
        "Every number with a name in the rooms that a verdict comes from was halved, and doubled, and the same "
        f"synthetic cases were diagnosed again (`python -m benchmarks.gap_constants`): {cases} cases drawn at home, "
        f"{nothing} of them without an effect. What most of them are: [theory](../theory/gap_diagnosis.md). Made by "
        f"`python -m website.pages` from {'; '.join(calls)}."
    )
    before = (
        f"With the constants as they are: {alarms} false alarms in {nothing} cases, the right effect first in {first} "
        f"of {cases - nothing}, {failed} that failed. An answer is moved where its verdict or its first name is "
        "another one. Constants were tried in groups, and one by one where a group moved an answer: two that undo each "
        "other would be missed. Where a number ends the diagnosis, as the doubled CYCLES does since its shortest "
        "window holds no frequency, an answer counts as moved and as failed: neither as a false alarm nor as right. "
        "Not tried: rooms that only localise, report or propose, tables of several values, numbers without a name; "
        f"most on foot and shoulder. Some were tried on more cases. A constant that moves none of {cases} answers may "
        f"still move {unseen:.0f} % of all (95 %)."
    )
    return ["# Constants of the diagnosis, halved and doubled", what, before]


def table(rows: list[tuple[str, float, list[dict[str, int] | None]]]) -> str:
    """Constants that move an answer."""
    effects = (f"{word}: moved, false alarms, first, failed" for word in FACTORS.values())
    lines = ["| constant | value | " + " | ".join(effects) + " |", "|---|---|---|---|"]
    for label, value, effects in rows:
        lines.append(f"| `{label}` | {value:.4g} | " + " | ".join(map(said, effects)) + " |")
    return "\n".join(lines)


def foot(rows: list[tuple[str, float, list[dict[str, int] | None]]]) -> list[str]:
    """Constants that move none, and what was not tried."""
    whole = [f"`{label}` ({value:.4g})" for label, value, effects in rows if all(one is not None for one in effects)]
    rest = [f"`{label}`" for label, _, effects in rows if any(one is None for one in effects)]
    parts = [f"## {len(whole)} that move no answer", ", ".join(whole) + "."]
    return parts + (["## Not tried with every factor", ", ".join(rest) + "."] if rest else [])


def effect(runs: list[dict[str, Any]], label: str, factor: str) -> dict[str, int] | None:
    """Answers moved, false alarms, right ones first and failures, of all runs; None where one did not come to it."""
    found = {"moved": 0, "of": 0} | dict.fromkeys(KINDS, 0)
    for run in (run for run in runs if label in run["constants"]):
        told = run["constants"][label].get(factor)
        if told is None:
            return None
        after = run["before"] if told == "moves nothing" else told["after"]
        found["moved"] += 0 if told == "moves nothing" else len(told["moved"])
        found["of"] += run["answers"]
        for kind in KINDS:
            found[kind] += after.get(kind, 0)
    return found


def moved(one: dict[str, int] | None) -> int:
    """How many answers; none where it was not tried."""
    return one["moved"] if one else 0


def said(one: dict[str, int] | None) -> str:
    """The four figures as a cell of the table has them."""
    return f"{one['moved']} of {one['of']}, {', '.join(str(one[kind]) for kind in KINDS)}" if one else "not tried"
