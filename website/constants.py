"""Constants of the diagnosis and what they move: docs/reference/gap_constants.md, from `benchmarks.gap_constants`."""

from __future__ import annotations

import json
from typing import Any

from benchmarks.constants_of import constants as found_in
from benchmarks.gap_constants import ROOMS
from website.stage import ROOT

PAGE = "docs/reference/gap_constants.md"
RESULTS = "benchmarks/results/gap_constants*.json"
FACTORS = {"times 0.5": "halved", "times 2": "doubled"}
KINDS = ("false_alarms", "first_right", "failed")


WHERE = {
    "gap.localise.": "where a gap lies (`where`, the map)",
    "gap.reduction.": "the reduction and its interval",
    "gap.experiment.": "the next experiment",
    "gap.identifiability.": "which effects count as absorbed",
    "gap.diagnose.": "which parameters count as identifiable",
}
"""What constants of rooms move that no verdict comes from."""


def constants() -> str:
    """The whole page; the runs' cases are added up."""
    runs = [json.loads(file.read_text(encoding="utf-8")) for file in sorted(ROOT.glob(RESULTS))]
    judging = {one.label: one.value for one in found_in(ROOMS)}
    every = {one.label: one.value for one in found_in(("gap", "identify"))}
    rows = [
        (label, value, [effect(runs, label, value, factor) for factor in FACTORS]) for label, value in judging.items()
    ]
    moving = sorted((row for row in rows if any(map(moved, row[2]))), key=lambda row: -sum(map(moved, row[2])))
    still = [row for row in rows if not any(map(moved, row[2]))]
    aside = [label for label in every if label not in judging]
    return "\n\n".join([*head(runs, len(judging)), table(moving), *foot(still), *beside(aside)]) + "\n"


def head(runs: list[dict[str, Any]], count: int) -> list[str]:
    """What was done, and what is true before anything is changed; `count` constants move a verdict."""
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
        f"{count} numbers with a name stand in the rooms that a verdict comes from. Such numbers were halved, and "
        "doubled, and the same synthetic cases were diagnosed again (`python -m benchmarks.gap_constants`): "
        f"{cases} cases drawn at home, {nothing} of them without an effect; some numbers on more. What each is and "
        "where it comes from: [theory](../theory/gap_diagnosis.md#constants). Made by `python -m website.pages` from "
        f"{'; '.join(calls)}."
    )
    since = (
        "The runs are of the commits that they name. Since then constants were merged: SURE, SLIGHT, TWOFOLD, "
        "DEVIATIONS, LEADING, FEWEST, ROUNDS, LIMIT, ROUNDING, TREND, OTHERS and CYCLES now also stand for what others "
        "did, and their rows are of what they did before. Numbers that are new, or have another value, were not tried."
    )
    before = (
        f"With the constants as they were: {alarms} false alarms in {nothing} cases, the right effect first in {first} "
        f"of {cases - nothing}, {failed} that failed. An answer is moved where its verdict or its first name is "
        "another one. Constants were tried in groups, and one by one where a group moved an answer: two that undo each "
        "other would be missed. Where a number ends the diagnosis an answer counts as moved and as failed: neither as "
        "a false alarm nor as right. Runs that moved every answer and did not count failures are left out, as if that "
        "factor had not been tried. Not tried: "
        "tables of several values, numbers without a name; most on foot and shoulder. A constant that moves none of "
        f"{cases} answers may still move {unseen:.0f} % of all (95 %)."
    )
    return ["# Constants of the diagnosis, halved and doubled", what, since, before]


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


def beside(labels: list[str]) -> list[str]:
    """Constants of rooms that work on a verdict that is there, by what they move."""
    by_room: dict[str, list[str]] = {}
    for label in labels:
        (room,) = (each for each in WHERE if label.startswith(each))
        by_room.setdefault(room, []).append(f"`{label}`")
    parts = [f"- {WHERE[room][0].upper()}{WHERE[room][1:]}: {', '.join(names)}." for room, names in by_room.items()]
    why = "These rooms work on a verdict that is there. None of their constants moves it, and none was tried:"
    return [f"## {len(labels)} that can move no verdict", why, "\n".join(parts)] if labels else []


def effect(runs: list[dict[str, Any]], label: str, value: float, factor: str) -> dict[str, int] | None:
    """Answers moved, false alarms, right ones first and failures, of all runs with this value.

    None where there is no such run, one did not come to it, or one moved all answers and did not count failures.
    """
    found = {"moved": 0, "of": 0} | dict.fromkeys(KINDS, 0)
    for run in (run for run in runs if run["constants"].get(label, {}).get("value") == value):
        told = run["constants"][label].get(factor)
        if told is None:
            return None
        if told != "moves nothing" and "failed" not in told["after"] and len(told["moved"]) == run["answers"]:
            return None
        after = run["before"] if told == "moves nothing" else told["after"]
        found["moved"] += 0 if told == "moves nothing" else len(told["moved"])
        found["of"] += run["answers"]
        for kind in KINDS:
            found[kind] += after.get(kind, 0)
    return found if found["of"] else None


def moved(one: dict[str, int] | None) -> int:
    """How many answers; none where it was not tried."""
    return one["moved"] if one else 0


def said(one: dict[str, int] | None) -> str:
    """The four figures as a cell of the table has them."""
    return f"{one['moved']} of {one['of']}, {', '.join(str(one[kind]) for kind in KINDS)}" if one else "not tried"
