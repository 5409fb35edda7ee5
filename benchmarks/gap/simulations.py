"""Simulations per second on one core: `python -m benchmarks.gap.simulations [practice folder]`.

One simulation is every trial of a case once; base model, then base model with each effect.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping
from pathlib import Path

from benchmarks import one_core

one_core.pin()

from benchmarks.area.tables import markdown  # noqa: E402
from benchmarks.machine import machine  # noqa: E402
from geocontact.chain.system import System  # noqa: E402
from geocontact.data.gap_case import GapCase  # noqa: E402
from geocontact.data.trial import Trial  # noqa: E402
from geocontact.effects.catalogue import candidates  # noqa: E402
from geocontact.io.cases.gap_case import read_gap_case  # noqa: E402
from geocontact.systems.catalogue import system_of  # noqa: E402

HERE = Path(__file__).resolve().parents[1]
CASES = ("elbow_01", "foot_01")


def per_second(system: System, trials: tuple[Trial, ...], values: Mapping[str, float], seconds: float) -> float:
    """Simulations of all trials per second of processor time; compiled and differentiated before the clock starts."""
    for trial in trials:
        system.simulate(trial, values)
    done, start = 0, time.process_time()
    while time.process_time() - start < seconds:
        for trial in trials:
            system.simulate(trial, values)
        done += 1
    return done / (time.process_time() - start)


def rows_of(case: GapCase, seconds: float) -> list[dict[str, object]]:
    """One row for the base and one per effect that has parameters."""
    system, trials = system_of(case), case.calibration + case.evaluation
    samples = sum(map(len, trials))
    rows: list[dict[str, object]] = []
    kinds = [("base", system, system.start)]
    kinds += [
        (one.label, one.apply(system), {**system.start, **one.starts[0]})
        for one in candidates(system)
        if one.parameters
    ]
    for name, model, values in kinds:
        speed = per_second(model, trials, values, seconds)
        rows.append({"case": case.name, "model": name, "samples": samples, "simulations_per_second": speed})
    return rows


def main() -> None:
    """Measure, print one table, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.simulations", description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", default=HERE.parents[1] / "shared" / "gap" / "practice")
    parser.add_argument("--seconds", type=float, default=1.0, help="processor time per row")
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    rows = [row for name in CASES for row in rows_of(read_gap_case(options.folder / name), options.seconds)]
    head = ["case", "model", "samples", "simulations/s"]
    body = [[str(r["case"]), str(r["model"]), str(r["samples"]), f"{r['simulations_per_second']:.0f}"] for r in rows]
    print(markdown(head, body))
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "chain.json").write_text(json.dumps({"machine": machine(), "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
