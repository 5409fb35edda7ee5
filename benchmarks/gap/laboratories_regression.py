"""Residual regression on the cases of laboratories: `python -m benchmarks.gap.laboratories_regression RUN.json`.

The cases of RUN.json (`benchmarks.gap.laboratories`) are drawn again from its seed, written and read back; the base
model is fitted as the diagnosis does, and its residual is regressed (`gap_benchmark/residual_regression.py`), without
and with trial-to-trial variation. A case that is drawn otherwise than in RUN.json ends the run. Figures are those of
the diagnosis, counted by the same code; they are written beside the diagnosis' own as RUN_regression.json.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from benchmarks.gap.laboratories import WORDS, Lot, label_of, read_back, told
from benchmarks.machine import as_json, commit, machine
from geocontact.gap_benchmark.generalisation import NUMBERS, figures_of

ANSWERERS = ("regression", "regression_aware")


def lots(run: Mapping[str, Any]) -> list[tuple[Lot, Mapping[str, Any]]]:
    """The cases of a run, each with its row."""
    seed = run["asked"]["seed"]
    return [(Lot(c["system"], c["kind"], seed, c["place"], c["laboratory"]), c) for c in run["cases"]]


def answered(lot: Lot, row: Mapping[str, Any], folder: Path) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """Label and answers of the regressions, with their CPU seconds; a regression that breaks down is wrong."""
    from threadpoolctl import threadpool_limits

    from geocontact.analyses.frame.json_file import plain
    from geocontact.analyses.gap.benchmark.case import failed
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.case.admission import admitted
    from geocontact.gap.case.preparation import problem_of
    from geocontact.gap_benchmark.drawing import drawn
    from geocontact.gap_benchmark.residual_regression import residual_regression
    from geocontact.io.cases.gap_case import read_gap_case
    from geocontact.io.cases.gap_case_writer import write_gap_case
    from geocontact.systems.catalogue import system_of

    planted = drawn(lot)
    label = label_of(planted)
    if label["effects"] != row["planted"] or not same_numbers(label["nats"], row["nats"]):
        sys.exit(f"{lot}: {label['effects']} is drawn where the run has {row['planted']}: other sources")
    write_gap_case(planted.case, folder / planted.case.name)
    case = read_gap_case(folder / planted.case.name)
    said: dict[str, dict[str, Any]] = {}
    with threadpool_limits(limits=1):
        began = time.process_time()
        try:
            system = system_of(case)
            problem = problem_of(admitted(case, system), system)
            offered, fitted = candidates(problem.system), time.process_time() - began
            for name in ANSWERERS:
                began = time.process_time()
                found = plain(residual_regression(problem, offered, aware=name == "regression_aware"))
                said[name] = found | {"seconds": fitted + time.process_time() - began}
        except (ArithmeticError, LookupError, RuntimeError, ValueError) as error:
            print(f"{lot}: {type(error).__name__}: {error}", file=sys.stderr)
    return label, {name: said.get(name, failed(label)) for name in ANSWERERS}


def same_numbers(here: Mapping[str, float], there: Mapping[str, float]) -> bool:
    """Whether both say the same of how visible each effect is, to six digits."""
    return here.keys() == there.keys() and all(math.isclose(here[one], there[one], rel_tol=1e-6) for one in here)


def main() -> int:
    """Draw, regress, score, write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.laboratories_regression", description=__doc__)
    parser.add_argument("run", type=Path, help="JSON of benchmarks.gap.laboratories")
    o = parser.parse_args()
    run = json.loads(o.run.read_text(encoding="utf-8"))
    out = o.run.with_name(f"{o.run.stem}_regression.json")
    pairs: dict[str, list[tuple[dict[str, Any], dict[str, Any]]]] = {name: [] for name in ANSWERERS}
    for lot, row in lots(run):
        with tempfile.TemporaryDirectory() as folder:
            label, answers = answered(lot, row, Path(folder))
        for name in ANSWERERS:
            pairs[name].append((label, answers[name]))
        named = answers["regression"]["effects"]
        print(f"{lot.system} {lot.kind} {lot.place}: {label['effects']} -> {named}", flush=True)
        figures = {name: told(figures_of(some)) for name, some in pairs.items()}
        whole = {"what": __doc__.splitlines()[0], "commit": commit(), "run": o.run.name, "machine": machine()}
        out.write_text(as_json({**whole, "asked": run["asked"], "figures": figures}), encoding="utf-8")
    sides = [read_back(run["figures"]["all"]), *(read_back(figures[name]) for name in ANSWERERS)]
    for name, words in WORDS.items():
        cells = [f"{s.numbers[name]:.3g}" if name in NUMBERS else str(s.shares[name]) for s in sides]
        print(f"| {words} | " + " | ".join(cells) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
