"""Verdicts on synthetic cases, and nothing else of the report: `python -m benchmarks.gap.verdicts --seed N`.

The cases of `geocontact gap benchmark` (`gap_benchmark.drawing`), drawn, written, read back and attributed one after
the other, systems and laboratories in turns, until all are done or so many minutes are over. What the report adds to a
verdict costs as much again and changes nothing of it. Every case is added to a file beside the JSON as it is done, and
the same call goes on where a run of the same commit ended.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import commit, machine
from geocontact.gap_benchmark.drawing import ABROAD, HOME, SYSTEMS, Lot, lots

HERE = Path(__file__).resolve().parents[1]
TOLD = (
    "false_alarms",
    "sure_alarms",
    "harm_in_sum",
    "first_right",
    "first_right_anew",
    "named_right",
    "named_right_anew",
    "in_small_set",
    "missed",
    "confidently_wrong",
)
"""Figures that need no more than a verdict and held-out errors."""


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.verdicts", description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--laboratory", choices=[HOME, "abroad"], default=HOME)
    parser.add_argument("--kinds", nargs="+", default=["none"])
    parser.add_argument("--cases", type=int, default=40, help="of each system")
    parser.add_argument("--minutes", type=float, default=np.inf, help="after which no further case is begun")
    parser.add_argument("--out", type=Path, required=True, help="the JSON; cases go to the same name, .rows")
    return parser.parse_args()


def attributed(lot: Lot) -> dict[str, Any]:
    """Truth and answer of one case."""
    with tempfile.TemporaryDirectory() as scratch:
        folder, label = written(lot, Path(scratch))
        return {"lot": asdict(lot), "label": label, "answer": answer_of(folder)}


def written(lot: Lot, scratch: Path) -> tuple[Path, dict[str, Any]]:
    """The folder of a case, drawn and written below `scratch`, and its truth."""
    from geocontact.analyses.frame.json_file import plain
    from geocontact.gap_benchmark.drawing import drawn
    from geocontact.io.cases.gap_case_writer import write_gap_case

    planted = drawn(lot)
    folder = scratch / planted.case.name
    write_gap_case(planted.case, folder)
    return folder, dict(plain(planted.label.as_dict()))


def answer_of(folder: Path) -> dict[str, Any]:
    """The case in a folder, read and attributed on one thread."""
    from threadpoolctl import threadpool_limits

    from geocontact.analyses.frame.json_file import plain
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.attribute import attribute
    from geocontact.gap.case.admission import admitted
    from geocontact.gap.selection.verdict import with_lapses
    from geocontact.io.cases.gap_case import read_gap_case
    from geocontact.systems.catalogue import system_of

    with threadpool_limits(limits=1):
        began, case = time.process_time(), read_gap_case(folder)
        system = system_of(case)
        found = attribute(admitted(case, system), system, candidates)
        said, most = with_lapses(found.answer, found.offered), max(found.contenders, key=lambda one: one.nats)
        answer = {
            "verdict": said.verdict,
            "effects": said.effects,
            "probabilities": said.probabilities,
            "ambiguity": said.ambiguity,
            "gap": held_out_errors(found),
            "seconds": time.process_time() - began,
            "most": [most.label, most.nats - found.base.nats, found.objections.get(most.label, "")],
        }
        return dict(plain(answer))


def held_out_errors(found: Any) -> dict[str, dict[str, float]]:
    """Errors of the base model and of what is named, per channel, as they are reported; none where nothing is named."""
    from geocontact.gap.case.plain_fit import measured_fit

    if not found.answer.effects or found.data_error is not None:
        return {}
    problem, named = found.clean, found.answer.chosen.judged.model
    held = problem.recorded.present[len(problem.calibration.trials) :]
    both = []
    for model in (problem.plain, named):
        parts = measured_fit(problem, model, problem.floor)[1][-len(held) :]
        squares = sum((np.where(there, part, 0.0) ** 2).sum(axis=0) for part, there in zip(parts, held, strict=True))
        both.append(np.sqrt(squares / sum(there.sum(axis=0) for there in held)))
    return {
        name: {"rmse_before": before, "rmse_after": after, "reduction": 1.0 - after / before}
        for name, before, after in zip(problem.system.outputs, *both, strict=True)
    }


def figures_of(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Of some cases: the figures in `TOLD`, and processor seconds."""
    from geocontact.gap_benchmark.score import figures, score

    names = [str(place) for place in range(len(rows))]
    labels = {name: row["label"] for name, row in zip(names, rows, strict=True)}
    said = {name: row["answer"] for name, row in zip(names, rows, strict=True)}
    every = figures(score(labels, said))
    return {name: every[name] for name in (*TOLD, "seconds")}


def done(log: Path, what: str, chosen: Sequence[Lot]) -> list[dict[str, Any]]:
    """Rows of these cases that a run of the same commit has written."""
    written = log.read_text(encoding="utf-8").splitlines() if log.exists() else []
    asked, rows = [asdict(lot) for lot in chosen], [json.loads(line) for line in written]
    return [row for row in rows if row.get("commit") == what and row["lot"] in asked]


def report(o: argparse.Namespace, what: str, rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """By system, by laboratory, pooled."""
    scopes: dict[str, list[Mapping[str, Any]]] = {"all": list(rows)}
    for row in rows:
        lot = row["lot"]
        for name in (lot["system"], lot["laboratory"], f"{lot['system']}, {lot['laboratory']}"):
            scopes.setdefault(name, []).append(row)
    asked = {"seed": o.seed, "laboratory": o.laboratory, "kinds": o.kinds, "cases": o.cases, "done": len(rows)}
    told = {name: figures_of(some) for name, some in scopes.items()}
    return {"what": __doc__.splitlines()[0], "commit": what, **asked, **machine(), "figures": told}


def main() -> int:
    """Attribute, score, write."""
    from geocontact.analyses.gap.benchmark.result import mixed
    from geocontact.data.errors import InputError
    from geocontact.gap_benchmark.synthetic.cases import NotFoundError

    o = arguments()
    log, what, began = o.out.with_suffix(".rows"), commit(), time.monotonic()
    chosen = mixed(list(lots(SYSTEMS, o.cases, o.kinds, o.seed, ABROAD if o.laboratory == "abroad" else (HOME,))))
    rows = done(log, what, chosen)
    for lot in [one for one in chosen if asdict(one) not in [row["lot"] for row in rows]]:
        if time.monotonic() - began > 60.0 * o.minutes:
            break
        try:
            row = {"commit": what, **attributed(lot)}
        except NotFoundError as error:
            print(f"{lot.system} {lot.laboratory} {lot.place} was not drawn: {error}", flush=True)
            continue
        except InputError as error:  # too few samples, say: no verdict, so neither right nor wrong
            print(f"{lot.system} {lot.laboratory} {lot.place} was refused: {error}", flush=True)
            continue
        rows.append(row)
        with log.open("a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
        said = row["answer"]
        names = f"{', '.join(row['label']['effects']) or 'nothing'} -> {said['verdict']} {', '.join(said['effects'])}"
        print(f"{lot.system} {lot.laboratory} {lot.place}: {names}, {said['seconds']:.0f} s", flush=True)
        o.out.write_text(json.dumps(report(o, what, rows), indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
