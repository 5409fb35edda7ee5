"""What constants of the diagnosis move that no verdict comes from: `python -m benchmarks.gap.later_constants --seed N`.

The rooms that `benchmarks.gap.constants` leaves out work on a verdict that is there: where a gap lies, how far it
shrinks, what these trials would not show, what to record next. Synthetic cases, drawn at home, are attributed once.
Then every constant of these rooms is halved, and doubled, and what follows from the answer is worked out again. Told
are the parts of the diagnosis (and of the map of its gap) that change, the largest relative change of a number in
each, and how many true reductions lie inside their intervals. The verdict, its effects and their probabilities are
compared like every part.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from benchmarks.gap.constants import DRAWN, FAILED, ROOMS, choices, drawn_cases
from benchmarks.gap.constants_of import with_others
from benchmarks.machine import as_json, commit, machine
from geocontact.effects.catalogue import candidates
from geocontact.gap.attribute import attribute
from geocontact.gap.case.admission import admitted
from geocontact.gap.diagnose import findings
from geocontact.gap_benchmark.drawing import HOME, SYSTEMS
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of

HERE = Path(__file__).resolve().parents[1]
ASIDE = ("seconds", "version", "case", "system")
"""Parts of a diagnosis that are of the run, not of the answer."""
Told = dict[str, dict[str, Any]]


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.gap.later_constants", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--systems", nargs="+", default=list(SYSTEMS))
    parser.add_argument("--cases", type=int, default=2, help="of each system, shared by the kinds")
    parser.add_argument("--kinds", nargs="+", default=["none", "single"])
    parser.add_argument("--laboratories", nargs="+", default=[HOME], help="they take turns")
    parser.add_argument("--only", nargs="*", default=[], help="constants whose label begins so")
    parser.add_argument("--out", type=Path, default=HERE / "results" / "gap_told_constants.json")
    return parser.parse_args()


def attributed(folder: Path) -> Callable[[], dict[str, Any]]:
    """Attribute the case in a folder; what is returned works out what follows from the answer."""
    case = read_gap_case(folder)
    system = system_of(case)
    case = admitted(case, system)
    found = attribute(case, system, candidates)

    def follows() -> dict[str, Any]:
        whole = findings(case, found, time.perf_counter())
        parts = {name: part for name, part in whole.diagnosis.as_dict().items() if name not in ASIDE}
        return parts | {"map": [asdict(cell) for cell in whole.cells]}

    return follows


def told(cases: Mapping[str, Callable[[], dict[str, Any]]]) -> Told:
    """What follows from the answer of every case; a failure in words."""
    found: Told = {}
    for name, follows in cases.items():
        try:
            found[name] = follows()
        except Exception as error:  # noqa: BLE001 a constant that ends the diagnosis is a finding
            found[name] = {FAILED: type(error).__name__}
    return found


def changes(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, float]:
    """By part that differs: the largest change of a number, of the larger of both; 1 where more than numbers do."""
    both = {name: (before.get(name), after.get(name)) for name in {*before, *after}}
    return {name: change for name, pair in sorted(both.items()) if (change := _change(*pair)) > 0.0}


def _change(a: Any, b: Any) -> float:
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return max((_change(a[key], b[key]) for key in a), default=0.0)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)) and len(a) == len(b):
        return max((_change(*pair) for pair in zip(a, b, strict=True)), default=0.0)
    numbers = all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in (a, b))
    if numbers and a != b:
        return min(1.0, abs(a - b) / max(abs(a), abs(b)))
    return float(a != b and not (numbers and a != a and b != b))


def inside(truths: Mapping[str, dict[str, Any]], found: Told) -> tuple[int, int]:
    """True reductions inside their intervals, of those that a diagnosis gives where an effect is planted and named."""
    held = [
        low <= true <= high
        for name, truth in truths.items()
        if found[name].get("effects")
        for channel, true in truth["reduction"].items()
        for low, high in [found[name]["gap"][channel]["ci95"]]
    ]
    return sum(held), len(held)


def row(truths: Mapping[str, dict[str, Any]], before: Told, after: Told | None) -> dict[str, Any]:
    """What one constant moves: parts with their largest change over the cases, cases moved, reductions inside."""
    if after is None:
        return {"moved": len(before), "parts": {FAILED: 1.0}, "inside": [0, 0]}
    each = {name: changes(before[name], after[name]) for name in before}
    parts: dict[str, float] = {}
    for one in each.values():
        parts |= {name: max(change, parts.get(name, 0.0)) for name, change in one.items()}
    return {"moved": sum(map(bool, each.values())), "parts": parts, "inside": list(inside(truths, after))}


def main() -> int:
    """Attribute once, halve, double, write."""
    o = arguments()
    judging = {one.label for one in choices(ROOMS)}
    named = [one for one in choices(("gap", "identify")) if one.label not in judging]
    named = [one for one in named if not o.only or one.label.startswith(tuple(o.only))]
    asked = {"commit": commit()} | {name: vars(o)[name] for name in DRAWN}
    with tempfile.TemporaryDirectory() as scratch, threadpool_limits(limits=1):
        folders, truths = drawn_cases(o, Path(scratch))
        cases = {name: attributed(folder) for name, folder in folders.items()}
        work = partial(told, cases)
        before = with_others({}, work) or {}
        again = row(truths, before, with_others({}, work))
        if again["moved"]:
            print(f"the same constants tell another thing: {again['parts']}")
            return 1
        table: dict[str, dict[str, Any]] = {one.label: {"value": one.value} for one in named}
        for one in named:
            for factor in (0.5, 2.0):
                found = row(truths, before, with_others({one: one.times(factor)}, work))
                table[one.label][f"times {factor:g}"] = found
                print(f"{factor:g} x {one.label}: {found['moved']} of {len(cases)}, {found['parts']}", flush=True)
    result = {"what": __doc__.splitlines()[0], **asked, **machine(), "answers": len(cases)}
    result |= {"inside": list(inside(truths, before)), "constants": table}
    o.out.write_text(as_json(result), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
