"""Coverage of the intervals of E* on synthetic trials: `python -m benchmarks.modulus [--runs 2000]`.

One step of 1.1 s at 101 frames (and at 41, and two others), force by the reading "disc" of a smooth synthetic area,
E* 6.8 MPa, Ornstein-Uhlenbeck noise of 100 N and the correlation times of the table. An interval of 95 % is right
when it holds the true value in 93 to 97 % of the runs.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parent
CASES = ((101, 0.02), (101, 0.05), (41, 0.05), (41, 0.1))
"""Frames and correlation time [s]."""

NOISE = 100.0  # N


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.modulus", description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=2000)
    parser.add_argument("--replicates", type=int, default=400)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine
    from tests.identify.synthetic_contact import coverage

    rows = []
    for frames, tau in CASES:
        begun = time.process_time()
        told = coverage(options.runs, frames, NOISE, tau, options.replicates, options.seed)
        seconds = (time.process_time() - begun) / options.runs
        rows.append(
            {"frames": frames, "tau_s": tau, "runs": options.runs, **told, "seconds_per_run": round(seconds, 4)}
        )
        print(json.dumps(rows[-1]), flush=True)
    report = {"machine": machine(), "noise_N": NOISE, "replicates": options.replicates, "coverage": rows}
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "modulus.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
