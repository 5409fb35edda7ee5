"""The diagnosis on kinds of laboratories: `python -m benchmarks.gap.laboratories --kinds fresh --seed N --out FILE`.

Cases of every system are recorded by laboratories of every kind at home, or abroad, or fresh, in turn
(`gap_benchmark/synthetic/laboratories/kinds.py`), written, read back and diagnosed as `geocontact gap diagnose` does.
Every case is added to a journal beside the JSON as it is done, and the same call goes on where a run of the same
sources ended. `--table HOME.json OTHER.json` prints the table and the generalisation loss of two runs.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import as_json, commit, machine
from geocontact.analyses.gap.benchmark.case import Journal, Worked
from geocontact.gap_benchmark.drawing import SYSTEMS, Lot
from geocontact.gap_benchmark.generalisation import NUMBERS, LaboratoryFigures, figures_of, losses
from geocontact.gap_benchmark.score import Rate
from geocontact.gap_benchmark.synthetic.laboratories.kinds import SIDES, kinds_of

COUNTED = {"none": "none", "single": "single", "unknown": "outside", "pairs": "pair"}
"""Options, and the kinds of cases that they count."""
WORDS = {
    "false_alarms": "false alarms, cases that lack nothing",
    "sure_alarms": "– with p ≥ 0.9",
    "large_named": "effects of 5 % of the error and more: named, or their class",
    "large_wrong": "– named wrongly",
    "small_detected": "effects of 1 to 5 %: named or detected",
    "pair_both": "pairs of 5 % and more: both",
    "pair_one": "– one right",
    "pair_no_wrong": "– no wrong name",
    "strange_unknown": "outside the table, 5 % and more: unknown or explained in part",
    "strange_wrong": "outside the table or nothing missing: something named",
    "budget_inside": "shares of effects inside ci95, where named right",
    "budget_closed": "budgets that close to 1 ± 0.02",
    "ahead": "visible singles that are ahead by 3 nats",
    "first_ahead": "– of these first",
    "set_ahead": "– of these in a set of three",
    "class_elsewhere": "of the other visible singles: class right",
    "class_named": "– class named",
    "class_right": "classes stated, truth in them, all cases",
    "class_size": "– effects in such a class, mean",
    "first_right": "first, all visible singles",
    "first_right_anew": "– visible though all is placed anew",
    "in_small_set": "in a set of three, all visible singles",
    "named_right": "named, all visible singles",
    "missed": "called no gap, all visible singles",
    "confidently_wrong": "confidently wrong, all cases",
    "both_found": "both of two",
    "unknown_called": "outside the table, called unknown",
    "coverage": "reductions inside ci95",
    "reduction_error": "mean error of reduction",
    "reduction_error_median": "– median",
    "log_score": "log score, 0 constant, 1 certain",
    "seconds_median": "CPU seconds per case, median",
    "seconds_most": "– most",
}


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.laboratories", description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", choices=SIDES, help="of laboratories")
    parser.add_argument("--seed", type=int)
    parser.add_argument("--out", type=Path, help="the JSON; cases go to the same name, .rows")
    parser.add_argument("--systems", nargs="+", default=list(SYSTEMS), choices=SYSTEMS)
    for name in COUNTED:
        parser.add_argument(f"--{name}", type=int, default=0, help="cases of each system")
    parser.add_argument("--workers", type=int, choices=(1, 2), default=1)
    parser.add_argument("--minutes", type=float, default=float("inf"), help="after which no further case is begun")
    parser.add_argument("--table", nargs=2, type=Path, metavar=("HOME", "OTHER"), help="compare two runs' JSON")
    o = parser.parse_args()
    if not o.table and (o.kinds is None or o.seed is None or o.out is None):
        parser.error("--kinds, --seed and --out are needed, or --table")
    return o


def asked(o: argparse.Namespace) -> list[Lot]:
    """Cases in turns: every beginning has systems, sorts of cases and kinds of laboratories in about equal shares."""
    names = kinds_of(o.kinds)
    chosen: list[tuple[float, Lot]] = []
    for row, system in enumerate(o.systems):
        for column, (option, kind) in enumerate(COUNTED.items()):
            count = getattr(o, option)
            for turn in range(count):
                which = (turn + 3 * row + 2 * column) % len(names)
                chosen.append(((turn + 0.5) / count, Lot(system, kind, o.seed, turn, names[which])))
    return [lot for _, lot in sorted(chosen, key=lambda one: one[0])]


def diagnosed(work: tuple[Lot, float]) -> Worked | None:
    """Truth and answer of one case, on one core; None when it is too late to begin it."""
    from threadpoolctl import threadpool_limits

    lot, until = work
    if time.time() > until:
        return None
    with threadpool_limits(limits=1), tempfile.TemporaryDirectory() as scratch:
        return answered(lot, Path(scratch))


def answered(lot: Lot, folder: Path) -> Worked:
    """As a user would hand it in."""
    from geocontact.analyses.frame.json_file import plain
    from geocontact.analyses.gap.benchmark.case import failed, from_folder
    from geocontact.gap_benchmark.drawing import drawn
    from geocontact.gap_benchmark.synthetic.cases import NotFoundError
    from geocontact.io.cases.gap_case_writer import write_gap_case

    try:
        planted = drawn(lot)
    except NotFoundError as error:
        return Worked(lot, "", None, {}, trouble=(str(error),))
    label, name = label_of(planted), planted.case.name
    write_gap_case(planted.case, folder / name)
    began = time.process_time()
    try:
        said = plain(from_folder(folder / name).diagnosis.as_dict())
    except (ArithmeticError, LookupError, RuntimeError, ValueError) as error:  # told, and scored as wrong
        trouble = (f"{type(error).__name__}: {error}",)
        return Worked(lot, name, label, {"diagnosis": failed(label)}, trouble=trouble)
    cpu = time.process_time() - began
    return Worked(lot, name, label, {"diagnosis": said | {"seconds": cpu}}, cpu=cpu)


def label_of(planted: Any) -> dict[str, Any]:
    """The truth of a case as JSON takes it, with what candidates leave of it."""
    from geocontact.analyses.frame.json_file import plain

    label: dict[str, Any] = plain(planted.label.as_dict())
    return label | plain(what_can_be_told(planted))


def what_can_be_told(planted: Any) -> dict[str, Any]:
    """What candidates leave of a single effect; whether one imitates an effect outside the table."""
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.case.admission import admitted
    from geocontact.gap_benchmark.answers import LEFT, confounding, left_by_effect
    from geocontact.systems.catalogue import system_of

    label = planted.label
    if label.kind not in ("single", "outside"):
        return {}
    system = system_of(planted.case)
    system = system.scaled(admitted(planted.case, system).calibration)
    offered = candidates(system)
    if label.kind == "single":
        return {"left": left_by_effect(system, planted.ideal, offered, label.floor)}
    left, by = confounding(system, planted.ideal, offered, label.floor)
    return {"imitated": left < LEFT, "imitation": {"left": left, "by": by}}


def told(figures: LaboratoryFigures) -> dict[str, Any]:
    """As JSON takes it."""
    shares = {
        name: {"hits": rate.hits, "count": rate.count, "ci95": list(rate.interval())}
        for name, rate in figures.shares.items()
    }
    return {"cases": figures.cases, "shares": shares, "numbers": dict(figures.numbers)}


def read_back(row: Mapping[str, Any]) -> LaboratoryFigures:
    """The same from JSON."""
    shares = {name: Rate(one["hits"], one["count"]) for name, one in row["shares"].items()}
    numbers = {name: np.nan if one is None else one for name, one in row["numbers"].items()}
    return LaboratoryFigures(row["cases"], shares, numbers)


def report(o: argparse.Namespace, rows: Sequence[Worked]) -> dict[str, Any]:
    """In all, by system, by kind of laboratory; and every case in a line."""
    good = [row for row in rows if row.label is not None]
    scopes: dict[str, list[Worked]] = {"all": good}
    for row in good:
        for name in (row.lot.system, row.lot.laboratory):
            scopes.setdefault(name, []).append(row)
    figures = {
        name: told(figures_of([(row.label or {}, row.answers["diagnosis"]) for row in some]))
        for name, some in scopes.items()
    }
    options = {name: getattr(o, name) for name in ("kinds", "seed", "systems", "workers", *COUNTED)}
    whole = {"what": __doc__.splitlines()[0], "commit": commit(), "asked": options, "machine": machine()}
    return {**whole, "not_drawn": len(rows) - len(good), "figures": figures, "cases": [line_of(row) for row in good]}


def line_of(row: Worked) -> dict[str, Any]:
    """What was planted and what was said."""
    from geocontact.gap_benchmark.answers import ahead_by
    from geocontact.gap_benchmark.score import confidently_wrong

    label, said = row.label or {}, row.answers["diagnosis"]
    lot = row.lot
    found = {"system": lot.system, "kind": lot.kind, "place": lot.place, "laboratory": lot.laboratory}
    found |= {"planted": label["effects"], "nats": label["nats"], "ahead": ahead_by(label)}
    found |= {"verdict": said["verdict"], "effects": said["effects"], "ambiguity": said["ambiguity"]}
    found["one_law"] = said.get("one_law", [])
    probable = sorted(said["probabilities"].items(), key=lambda pair: -pair[1])[:3]
    found |= {"probabilities": dict(probable), "confidently_wrong": confidently_wrong(label, said)}
    return found | {"seconds": row.cpu, "trouble": list(row.trouble)}


def table(home: Mapping[str, Any], other: Mapping[str, Any]) -> Iterator[str]:
    """In all on two sides, the loss, and by system of the second; without figures that neither run counted."""
    there = [one for one in SYSTEMS if one in other["figures"]]
    one, two = (side["asked"]["kinds"] for side in (home, other))
    yield f"| figure | {one} | {two} | loss, points | " + " | ".join(f"{each}, {two}" for each in there) + " |"
    yield "|---" * (4 + len(there)) + "|"
    sides = [read_back(side["figures"]["all"]) for side in (home, other)]
    own = [read_back(other["figures"][one]) for one in there]
    lost = losses(*sides)
    for name, words in WORDS.items():
        if not any(name in side.shares or name in side.numbers for side in sides):
            continue
        cells = [_cell(side, name) for side in sides]
        if name in NUMBERS and not any(np.isnan(side.numbers.get(name, np.nan)) for side in sides):
            cells.append(f"{sides[0].numbers[name] - sides[1].numbers[name]:+.3g}")
        elif name in lost and min(side.shares[name].count for side in sides):
            one = lost[name]
            cells.append(f"{100 * one.points:+.0f} [{100 * one.low:+.0f}, {100 * one.high:+.0f}]")
        else:
            cells.append("not told")
        cells += [_cell(one, name) for one in own]
        yield f"| {words} | " + " | ".join(cells) + " |"


def _cell(figures: LaboratoryFigures, name: str) -> str:
    if name not in figures.shares and name not in figures.numbers:
        return "not counted"
    if name not in NUMBERS:
        return str(figures.shares[name]).replace("%", " %")
    return "not told" if np.isnan(figures.numbers[name]) else f"{figures.numbers[name]:.3g}"


def main() -> int:
    """Draw, diagnose, score, write."""
    from geocontact.analyses.frame.workers import each

    o = arguments()
    if o.table:
        print("\n".join(table(*(json.loads(path.read_text(encoding="utf-8")) for path in o.table))))
        return 0
    journal, chosen, until = Journal(o.out.with_suffix(".rows")), asked(o), time.time() + 60.0 * o.minutes
    left = [(lot, until) for lot in chosen if lot not in journal.done]
    for (lot, _), became in each(diagnosed, left, o.workers):
        if isinstance(became, BaseException):
            raise became
        if became is None:
            continue
        journal.keep(became if became.label is not None else replace(became, answers={}))
        said = became.answers.get("diagnosis", {"verdict": "not drawn", "effects": []})
        planted = ", ".join((became.label or {"effects": []})["effects"]) or lot.kind
        words = f"{planted} -> {said['verdict']} {', '.join(said['effects'])}"
        print(f"{lot.system} {lot.laboratory} {lot.place}: {words}, {became.cpu:.0f} s {became.trouble}", flush=True)
        rows = [journal.done[one] for one in chosen if one in journal.done]
        o.out.write_text(as_json(report(o, rows)), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
