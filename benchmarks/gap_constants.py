"""Which constants of the diagnosis move its answers: `python -m benchmarks.gap_constants --seed N --minutes M`.

Every constant of the rooms that a verdict comes from is halved, and doubled, and the same synthetic cases, drawn at
home, are attributed again. An answer is moved where the verdict or the first name is another one. Constants are tried
in groups: where a group changes no answer, none of it does (two that undo each other would be missed, which is said);
where it does, its halves are tried, down to single ones. Of these the table has the answers moved, false alarms,
those first ranked right and diagnoses that failed, beside what they were. Numbers inside compiled kernels stay as they
are. Every trial is added to a file beside the JSON as it is done, and the same call goes on where a run of the same
commit ended.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from benchmarks.constants_of import Constant, constants, put
from benchmarks.gap_verdicts import attributed
from benchmarks.machine import commit, machine
from geocontact.gap_benchmark.drawing import SYSTEMS, Lot, drawn, lots

HERE = Path(__file__).resolve().parent
ROOMS = (
    "gap.attribute", "gap.case", "gap.data_errors", "gap.inputs", "gap.levels", "gap.selection",
    "identify.intervals", "identify.noise", "identify.optimise", "identify.signals",
)  # fmt: skip
"""What is left out only draws, tells or proposes: localise, reduction, identifiability, experiment."""
FAILED = "failed"
"""How the verdict begins of a diagnosis that ended without one."""
Answers = dict[str, dict[str, Any]]


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap_constants", description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--systems", nargs="+", default=list(SYSTEMS))
    parser.add_argument("--cases", type=int, default=5, help="of each system, shared by the kinds")
    parser.add_argument("--kinds", nargs="+", default=["none", "single"])
    parser.add_argument("--group", type=int, default=12, help="constants that are tried together")
    parser.add_argument("--only", nargs="*", default=[], help="constants whose label begins so")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="after which no further trial is begun")
    parser.add_argument("--out", type=Path, default=HERE / "results" / "gap_constants.json")
    return parser.parse_args()


def answers(chosen: Sequence[Lot], changed: dict[Constant, float | int], send: Any) -> None:
    """Verdict and first name of every case with other constants: the work of a process."""
    put(changed)
    said: Answers = {}
    for lot in chosen:
        name = f"{lot.system} {lot.kind} {lot.place}"
        try:
            row = attributed(lot)
        except Exception as error:  # noqa: BLE001 a constant that ends the diagnosis is a finding
            truth = list(drawn(lot).label.effects)
            said[name] = {"verdict": f"{FAILED}: {type(error).__name__}", "first": "", "truth": truth}
            continue
        told = row["answer"]
        first = (*told["ambiguity"], *told["effects"], "")[0]
        said[name] = {"verdict": told["verdict"], "first": first, "truth": row["label"]["effects"]}
    send.send(said)


def apart(chosen: Sequence[Lot], changed: dict[Constant, float | int]) -> Answers:
    """The same in a process of its own, whose constants end with it; empty where it was killed."""
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
    receive, send = context.Pipe(duplex=False)
    process = context.Process(target=answers, args=(chosen, changed, send))
    process.start()
    send.close()
    try:
        return dict(receive.recv())
    except EOFError:
        return {}
    finally:
        process.join()


def figures(before: Answers, after: Answers) -> dict[str, Any]:
    """Answers moved; false alarms, first ranked right and failed diagnoses, before and after.

    A diagnosis that ended without an answer, or whose process was killed, has failed: that is neither a false alarm
    nor a right answer.
    """
    moved = [name for name, one in before.items() if _told(after.get(name)) != _told(one)]

    def counted(said: Answers) -> dict[str, int]:
        answered = [one for name in before if (one := said.get(name)) and not one["verdict"].startswith(FAILED)]
        return {
            "false_alarms": sum(not one["truth"] and one["verdict"] != "no_gap" for one in answered),
            "first_right": sum(one["first"] in one["truth"] for one in answered),
            "failed": len(before) - len(answered),
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


def main() -> int:
    """Halve, double, write."""
    o = arguments()
    what, began, log = commit(), time.monotonic(), o.out.with_suffix(".rows")
    chosen = list(lots(tuple(o.systems), o.cases, tuple(o.kinds), o.seed))
    named = [one for one in constants(ROOMS) if not o.only or one.label.startswith(tuple(o.only))]
    asked = {"commit": what, "seed": o.seed, "systems": o.systems, "kinds": o.kinds, "cases": o.cases}
    rows = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()] if log.exists() else []
    rows = [row for row in rows if row["asked"] == asked]

    def kept(row: dict[str, Any]) -> dict[str, Any]:
        rows.append({"asked": asked, **row})
        with log.open("a", encoding="utf-8") as file:
            file.write(json.dumps(rows[-1]) + "\n")
        o.out.write_text(json.dumps(report(asked, rows, named), indent=1) + "\n", encoding="utf-8")
        return rows[-1]

    plain = next((row for row in rows if not row["constants"]), None)
    base: Answers = (plain or kept({"constants": [], "factor": 1.0, "answers": apart(chosen, {})}))["answers"]

    def tried(group: Sequence[Constant], factor: float) -> dict[str, Any] | None:
        labels = [one.label for one in group]
        for row in rows:
            if row["constants"] == labels and row["factor"] == factor:
                return dict(row["figures"])
        if time.monotonic() - began > 60.0 * o.minutes:
            return None
        after = apart(chosen, {one: one.times(factor) for one in group})
        told = figures(base, after)
        kept({"constants": labels, "factor": factor, "figures": told})
        print(f"{factor:g} x {', '.join(labels)}: {len(told['moved'])} of {len(base)} moved", flush=True)
        return told

    for factor in (0.5, 2.0):
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
    answers = next(row["answers"] for row in rows if not row["constants"])
    told = {"answers": len(answers), "before": figures(answers, answers)["before"]}
    told["nothing_missing"] = sum(not one["truth"] for one in answers.values())
    return {"what": __doc__.splitlines()[0], **asked, **machine(), **told, "constants": table}


if __name__ == "__main__":
    sys.exit(main())
