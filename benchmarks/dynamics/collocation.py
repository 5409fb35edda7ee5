"""Collocation on closed answers and on standing up: `python -m benchmarks.dynamics.collocation [--intervals 50]
[--no-chain]`.

Orders of convergence at the nodes, then phase A of one synthetic passive trial on the chain of six coordinates: CPU
seconds, iterations, parameters beside the planted ones, certificate. Everything is synthetic; truth and calibration
share their equations.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
COUNTS = (2, 4, 8)


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.dynamics.collocation", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--intervals", type=int, default=50)
    parser.add_argument("--no-chain", action="store_true", help="closed answers only")
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    report: dict[str, Any] = {"machine": machine(), "versions": versions({"casadi", "numpy", "scipy"})}
    report["orders"] = orders()
    if not options.no_chain:
        report["phase A"] = phase_a_of_one_trial(options.intervals)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "collocation.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(report, indent=2))


def orders() -> list[dict[str, Any]]:
    """Errors of a linear-quadratic problem's end and of the brachistochrone's time, and their orders."""
    import numpy as np

    from geocontact.dynamics.collocation.solve import SolverOptions, solve
    from tests.dynamics.collocation.closed_problems import brachistochrone, cycloid_time, exponential

    rows = []
    for kind in ("radau", "legendre"):
        for degree in (2, 3):
            problem, exact = exponential()
            ends, times = [], []
            began = time.process_time()
            for count in COUNTS:
                options = SolverOptions(kind, degree, count, 1e-12)
                ends.append(abs(float(solve(problem, options).motions[0].end[0]) - exact))
                times.append(abs(solve(brachistochrone(), options).objective - cycloid_time()))
            row = {"points": kind, "degree": degree, "cpu seconds": time.process_time() - began}
            for name, errors in (("linear-quadratic", ends), ("brachistochrone", times)):
                row[name] = {"errors": errors, "orders": np.log2(np.array(errors[:-1]) / errors[1:]).round(2).tolist()}
            rows.append(row)
    return rows


def phase_a_of_one_trial(intervals: int) -> dict[str, Any]:
    """One synthetic trial: planted, found, certified."""
    import numpy as np

    from geocontact.dynamics.collocation.certificate import certificate, resimulation
    from geocontact.dynamics.collocation.solve import SolverOptions, solve
    from geocontact.dynamics.simulate import Stepper
    from geocontact.standing_up.chain import LAW, PLANTED, TURNING, Subject, feet_on_ground
    from geocontact.standing_up.phases import phase_a
    from geocontact.standing_up.trials import StandingNoise, recorded, standing_up

    subject, noise = Subject(), StandingNoise()
    feet = feet_on_ground(subject)
    _, truth = standing_up(feet, subject, intervals=intervals)
    trial = recorded(feet, truth.motions[0], truth.p, 100.0, noise, 34)
    problem = phase_a(feet, subject, [trial], noise).control
    found = solve(problem, SolverOptions("radau", 4, intervals, 1e-7))
    began = time.process_time()
    again = resimulation(Stepper(feet.equations), found.motions[0], found.p, lambda t: np.zeros((len(t), 0)), range(3))
    seen = certificate(found.solved, problem.system, problem.trials[0], again, TURNING)
    return {
        "synthetic trial": {"ending": truth.ending, "cpu seconds": truth.seconds, "iterations": truth.iterations},
        "ending": found.ending,
        "cpu seconds": found.seconds,
        "iterations": found.iterations,
        "objective": found.objective,
        "parameters": {n: {"planted": a, "found": b} for n, a, b in zip(LAW, PLANTED, found.p, strict=False)},
        "certificate": vars(seen),
        "certificate cpu seconds": time.process_time() - began,
    }


if __name__ == "__main__":
    main()
