"""Which constants of the diagnosis move its answers: `python -m benchmarks.gap.constants --seed N --minutes M`.

Every constant of the rooms that a verdict comes from is halved, and doubled, and the same synthetic cases, drawn at
home, are attributed again. An answer is moved where the verdict or the first name is another one. Constants are tried
in groups: where a group changes no answer, none of it does (two that undo each other would be missed, which is said);
where it does, its halves are tried, down to single ones. Of these the table has the answers moved, false alarms,
those first ranked right, diagnoses that failed and the mean logarithm of the probability of the truth, beside what
they were. Of a table all values are changed. Cases are drawn before that. Numbers inside compiled kernels stay as they
are. Every trial is added to a file beside the JSON as it is done, and the same call goes on where a run of the same
commit ended.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.gap.constants_of import Constant, Value, constants, tables, with_others
from benchmarks.gap.verdicts import answer_of, written
from benchmarks.machine import as_json, commit, machine
from geocontact.gap_benchmark.drawing import HOME, SYSTEMS, lots
from geocontact.gap_benchmark.generalisation import log_probability

HERE = Path(__file__).resolve().parents[1]
ROOMS = (
    "gap.attribute", "gap.budget_verdict", "gap.case", "gap.data_errors", "gap.inputs", "gap.levels", "gap.selection",
    "gap.reduction.error_budget", "gap.reduction.repeats",
    "identify.intervals", "identify.noise", "identify.optimise", "identify.signals",
)  # fmt: skip
"""What is left out only draws, tells or proposes: localise, the rest of reduction, identifiability, experiment."""
DRAWN = ("seed", "systems", "kinds", "cases", "laboratories")
"""Options that cases are drawn by: runs that agree in them have the same ones."""
FAILED = "failed"
"""How the verdict begins of a diagnosis that ended without one."""
Answers = dict[str, dict[str, Any]]


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.constants", description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--systems", nargs="+", default=list(SYSTEMS))
    parser.add_argument("--cases", type=int, default=5, help="of each system, shared by the kinds")
    parser.add_argument("--kinds", nargs="+", default=["none", "single"])
    parser.add_argument("--laboratories", nargs="+", default=[HOME], help="they take turns")
    parser.add_argument("--group", type=int, default=12, help="constants that are tried together")
    parser.add_argument("--only", nargs="*", default=[], help="constants whose label begins so")
    parser.add_argument("--factors", nargs="+", type=float, default=[0.5, 2.0], help="that they are multiplied by")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="after which no further trial is begun")
    parser.add_argument("--out", type=Path, default=HERE / "results" / "gap_constants.json")
    return parser.parse_args()


def choices(rooms: Sequence[str]) -> list[Constant]:
    """Numbers of these rooms, then tables."""
    return [*constants(rooms), *tables(rooms)]


def answers(cases: Mapping[str, Path]) -> Answers:
    """Verdict, first name and probabilities of every case."""
    said: Answers = {}
    for name, folder in cases.items():
        try:
            told = answer_of(folder)
        except Exception as error:  # noqa: BLE001 a constant that ends the diagnosis is a finding
            said[name] = {"verdict": f"{FAILED}: {type(error).__name__}", "first": "", "probabilities": {}}
            continue
        first = (*told["ambiguity"], *told["effects"], "")[0]
        said[name] = {"verdict": told["verdict"], "first": first, "probabilities": told["probabilities"]}
    return said


def figures(truths: Mapping[str, dict[str, Any]], before: Answers, after: Answers) -> dict[str, Any]:
    """Answers moved; false alarms, first ranked right, failed diagnoses and nats, before and after.

    A diagnosis that ended without an answer, or whose process was killed, has failed: that is neither a false alarm
    nor a right answer. Nats are the mean logarithm of the probability that is stated for the truth, over the cases that
    are answered before and after; None where there are none.
    """
    moved = [name for name in truths if _told(after.get(name)) != _told(before.get(name))]

    def answered(said: Answers) -> list[str]:
        return [name for name in truths if name in said and not said[name]["verdict"].startswith(FAILED)]

    both = set(answered(before)) & set(answered(after))

    def counted(said: Answers) -> dict[str, float | None]:
        names = answered(said)
        nats = [log_probability(truths[name], said[name]) for name in truths if name in both]
        return {
            "false_alarms": sum(not truths[name]["effects"] and said[name]["verdict"] != "no_gap" for name in names),
            "first_right": sum(said[name]["first"] in truths[name]["effects"] for name in names),
            "failed": len(truths) - len(names),
            "nats": sum(nats) / len(nats) if nats else None,
        }

    return {"moved": moved, "before": counted(before), "after": counted(after)}


def _told(one: dict[str, Any] | None) -> tuple[str, str] | None:
    return None if one is None else (one["verdict"], one["first"])


def searched(
    group: Sequence[Constant], factor: float, tried: Callable[[Sequence[Constant], float], dict[str, Any] | None]
) -> None:
    """Try a group, and its halves where it moves an answer."""
    told = tried(group, factor)
    if told is None or not told["moved"] or len(group) == 1:
        return
    middle = len(group) // 2
    for half in (group[:middle], group[middle:]):
        searched(half, factor, tried)


def drawn_cases(o: argparse.Namespace, scratch: Path) -> tuple[dict[str, Path], dict[str, dict[str, Any]]]:
    """Folders and truths of the cases that are asked for, by name."""
    cases, truths = {}, {}
    for place, lot in enumerate(lots(tuple(o.systems), o.cases, tuple(o.kinds), o.seed, tuple(o.laboratories))):
        name = f"{lot.system} {lot.kind} {lot.place} {lot.laboratory}"
        cases[name], truths[name] = written(lot, scratch / str(place))
    return cases, truths


def main() -> int:
    """Draw, halve, double, write."""
    o = arguments()
    what, began, log = commit(), time.monotonic(), o.out.with_suffix(".rows")
    named = [one for one in choices(ROOMS) if not o.only or one.label.startswith(tuple(o.only))]
    asked = {"commit": what} | {name: vars(o)[name] for name in DRAWN}
    rows = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()] if log.exists() else []
    rows = [row for row in rows if row["asked"] == asked]

    def kept(row: dict[str, Any]) -> dict[str, Any]:
        rows.append({"asked": asked, **row})
        with log.open("a", encoding="utf-8") as file:
            file.write(json.dumps(rows[-1]) + "\n")
        o.out.write_text(as_json(report(asked, rows, named)), encoding="utf-8")
        return rows[-1]

    with tempfile.TemporaryDirectory() as scratch:
        cases, truths = drawn_cases(o, Path(scratch))

        def answered(changed: dict[Constant, Value]) -> Answers:
            return with_others(changed, partial(answers, cases)) or {}

        plain = next((row for row in rows if not row["constants"]), None)
        if plain is None:
            plain = kept({"constants": [], "factor": 1.0, "answers": answered({}), "truths": truths})
        base: Answers = plain["answers"]

        def tried(group: Sequence[Constant], factor: float) -> dict[str, Any] | None:
            labels = [one.label for one in group]
            for row in rows:
                if row["constants"] == labels and row["factor"] == factor:
                    return dict(row["figures"])
            if time.monotonic() - began > 60.0 * o.minutes:
                return None
            told = figures(truths, base, answered({one: one.times(factor) for one in group}))
            kept({"constants": labels, "factor": factor, "figures": told})
            print(f"{factor:g} x {', '.join(labels)}: {len(told['moved'])} of {len(truths)} moved", flush=True)
            return told

        for factor in o.factors:
            for at in range(0, len(named), o.group):
                searched(named[at : at + o.group], factor, tried)
    return 0


def report(asked: dict[str, Any], rows: Sequence[dict[str, Any]], named: Sequence[Constant]) -> dict[str, Any]:
    """By constant and factor: what moves, or that nothing of its group does, or that it was not reached."""
    table: dict[str, dict[str, Any]] = {one.label: {"value": one.value} for one in named}
    for row in rows:
        for label in row["constants"]:
            single = len(row["constants"]) == 1
            if label in table and (single or not row["figures"]["moved"]):
                table[label][f"times {row['factor']:g}"] = row["figures"] if single else "moves nothing"
    first = next(row for row in rows if not row["constants"])
    told = {
        "answers": len(first["truths"]),
        "before": figures(first["truths"], first["answers"], first["answers"])["before"],
    }
    told["nothing_missing"] = sum(not one["effects"] for one in first["truths"].values())
    return {"what": __doc__.splitlines()[0], **asked, **machine(), **told, "constants": table}


if __name__ == "__main__":
    sys.exit(main())
