"""CPU seconds of `gap diagnose`, case by case: `python -m benchmarks.gap.speed --seed N`, or `--cases FOLDER`.

The whole command with tables only, in a process of its own, on one core, one case after the other, warm: the first
case runs once beforehand to load what is compiled. Others at work on the machine make CPU seconds longer, so the
largest load average is told. Parts overlap: simulations are part of the contests. Every case is written into
benchmarks/results/gap_speed.json as it is done.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from benchmarks.one_core import pin
from benchmarks.whole_command import once

KINDS = ("none", "single", "pair")
PARTS = (
    ("geocontact.gap.attribute", "problem_of", "noise of the inputs, base model"),
    ("geocontact.gap.attribute", "_contest", "contests"),
    ("geocontact.gap.attribute", "surrogate", "surrogate"),
    ("geocontact.gap.case.problem", "most_likely", "search for noise"),
    ("geocontact.chain.system:System", "simulate", "simulations"),
    ("geocontact.systems.shoulder", "swing", "swing of the arm"),
    ("geocontact.gap.case.whitening:Whitening", "__call__", "whitening"),
    ("geocontact.gap.diagnose", "gap_map", "map"),
    ("geocontact.gap.diagnose", "next_experiment", "next experiment"),
)
"""What is timed: module, or module:class; function; what it is called."""


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.speed", description=__doc__.splitlines()[0])
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--seed", type=int, help="cases without an effect, with one and with two, of every system")
    source.add_argument("--cases", type=Path, help="a folder of cases instead")
    return parser.parse_args()


def written(seed: int, folder: Path, systems: Sequence[str] | None = None, kinds: Sequence[str] = KINDS) -> None:
    """A case of each kind of the benchmark's own generator, of all systems by default."""
    from geocontact.gap_benchmark.drawing import SYSTEMS, drawn, lots
    from geocontact.gap_benchmark.synthetic.cases import NotFoundError
    from geocontact.io.cases.gap_case_writer import write_gap_case

    for system in systems or SYSTEMS:
        for kind in kinds:
            (lot,) = lots([system], 1, [kind], seed)
            try:
                write_gap_case(drawn(lot).case, folder / f"{system}_{kind}")
            except NotFoundError as error:
                print(f"{system} {kind} was not drawn: {error}", flush=True)


def told(rows: dict[str, dict[str, float]]) -> dict[str, Any]:
    """Median and most over the cases, and every case."""
    whole = [row["all"] for row in rows.values()]
    return {"median_cpu_s": float(np.median(whole)), "most_cpu_s": max(whole), "cases_cpu_s": rows}


def main() -> int:
    """Diagnose, time, write."""
    o = arguments()
    pin()
    rows: dict[str, dict[str, float]] = {}
    loads: list[float] = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = o.cases or Path(scratch) / "cases"
        if o.cases is None:
            written(o.seed, folder)
        cases = sorted(each.parent for each in folder.glob("*/case.toml"))
        for case in (*cases[:1], *cases):
            found = once(["gap", "diagnose", str(case), "--out", str(Path(scratch) / "out"), "--bare"], PARTS)
            rows[case.name] = {name: round(seconds, 2) for name, seconds in found.items()}
            print(f"{case.name}: {rows[case.name]['all']} s", flush=True)
            asked = {"seed": o.seed} if o.cases is None else {"cases": o.cases.name}
            loads.append(os.getloadavg()[0])
            write_results(
                "gap_speed", asked, told(rows) | {"load_average": max(loads)}, frozenset({"numpy", "scipy", "numba"})
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
