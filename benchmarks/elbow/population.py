"""Largest forces of a synthetic population: `python -m benchmarks.elbow.population`.

Samples per second of one core beside the same grid of angles written for numpy arrays, turn by turn in one process; the
error against a grid of 0.02 degrees by step, with the refinement of the extremes and without; and the error of the
quantiles that drawing a finite number of people leaves.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
RANGE = (0.0, 120.0)  # degrees
STEPS = (8.0, 4.0, 2.0, 1.0)  # degrees
FINEST = 0.02  # degrees
CHECKED = 4000
BLOCK = 10_000  # people at a time for numpy; faster than all at once
MILLION = 1_000_000


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.elbow.population", description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    report = {
        "machine": machine(), "versions": versions({"scipy"}), "seed": options.seed, "range_deg": RANGE,
        "speed": speed(options.rounds, options.seed), "convergence": convergence(options.seed),
        "drawing": drawing(options.seed),
    }  # fmt: skip
    text = json.dumps(report, indent=1)
    print(text)
    (options.out / "elbow_population.json").write_text(text + "\n", encoding="utf-8")


def sampling():
    """The synthetic population of docs/how-to/elbow_design.md."""
    import numpy as np

    from geocontact.identify.intervals.sampling import Normal, Sampling, Uniform

    factors = (
        Normal("k", 222.0, 40.0, 50.0), Uniform("l", 0.16, 0.21), Uniform("z", 0.06, 0.13), Normal("x", 0.0, 0.015),
        Normal("y", 0.0, 0.02),
    )  # fmt: skip
    return Sampling(factors, np.eye(5), {})


def drawn(count: int, seed: int):
    """People of that population."""
    from geocontact.axis_misalignment.design import QUANTITIES

    one = sampling()
    return one.quantities(one.shares(count, seed), QUANTITIES)


def exposure():
    """Locked, over the range."""
    import numpy as np

    from geocontact.axis_misalignment.design import Exposure

    return Exposure(*np.radians(RANGE))


def by_numpy(people, step: float):
    """Largest |F| on the grid of angles only, arrays of people times angles."""
    import numpy as np

    from geocontact.axis_misalignment.planar_joint import grid

    beta = grid(*np.radians(RANGE), np.radians(step))
    s, c = np.sin(beta), np.cos(beta)
    peak = np.empty(len(people))
    for begin in range(0, len(people), BLOCK):
        k, l, z, x, y = people[begin : begin + BLOCK].T[:, :, None]
        reach = np.sqrt((l * s - x) ** 2 + (y + l * c) ** 2)
        d = y + np.sqrt(l * l - x * x) - reach - z * (x * c + y * s) / (l + y * c - x * s)
        peak[begin : begin + BLOCK] = np.abs(k * d).max(axis=1)
    return peak


def speed(rounds: int, seed: int) -> dict[str, object]:
    """Processor seconds of a million people, largest forces only; drawing them apart."""
    import numpy as np

    from geocontact.axis_misalignment.design import peak_forces

    begun = time.process_time()
    people = drawn(MILLION, seed)
    drawing_them = time.process_time() - begun
    peak_forces(people[:10], exposure())
    ours, wide, theirs = [], [], []
    jobs = (
        (ours, lambda: peak_forces(people, exposure())),
        (wide, lambda: peak_forces(people, exposure(), np.radians(STEPS[0]))),
        (theirs, lambda: by_numpy(people, 2.0)),
    )
    for _ in range(rounds):
        for seconds, work in jobs:
            begun = time.process_time()
            work()
            seconds.append(time.process_time() - begun)
    return {
        "people": MILLION,
        "samples_per_second": round(MILLION / float(np.median(ours))),
        "numpy_samples_per_second": round(MILLION / float(np.median(theirs))),
        "samples_per_second_at_8_deg": round(MILLION / float(np.median(wide))),
        "ratio": float(np.median(np.array(theirs) / np.array(ours))),
        "cpu_s": ours,
        "ratio_at_8_deg": float(np.median(np.array(theirs) / np.array(wide))),
        "cpu_s_at_8_deg": wide,
        "numpy_cpu_s": theirs,
        "drawing_cpu_s": drawing_them,
    }


def convergence(seed: int) -> list[dict[str, float]]:
    """Largest and root mean square error of the peak force [N] by step, refined and on the grid only."""
    import numpy as np

    from geocontact.axis_misalignment.design import peak_forces

    people = drawn(CHECKED, seed)
    true = peak_forces(people, exposure(), np.radians(FINEST))[0]
    rows = []
    for step in STEPS:
        refined = true - peak_forces(people, exposure(), np.radians(step))[0]
        coarse = true - by_numpy(people, step)
        rows.append({
            "step_deg": step,
            "largest_error_N": float(np.abs(refined).max()),
            "rms_error_N": float(np.sqrt(np.mean(refined**2))),
            "grid_only_largest_error_N": float(np.abs(coarse).max()),
            "grid_only_rms_error_N": float(np.sqrt(np.mean(coarse**2))),
        })  # fmt: skip
    return rows


def drawing(seed: int) -> list[dict[str, float]]:
    """The 95 % quantile and its interval by number of people."""
    import numpy as np

    from geocontact.axis_misalignment.design import peak_forces
    from geocontact.identify.intervals.quantile_intervals import quantile

    rows = []
    for count in (1000, 10_000, 100_000, MILLION):
        one = quantile(np.sort(peak_forces(drawn(count, seed), exposure())[0]), 0.95)
        rows.append({"people": count, "quantile_N": one.value, "lower_N": one.lower, "upper_N": one.upper})
    return rows


if __name__ == "__main__":
    main()
