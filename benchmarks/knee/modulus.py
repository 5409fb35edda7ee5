"""E* on synthetic trials: exact without noise, coverage of its intervals: `python -m benchmarks.knee.modulus [--runs
2000]`.

One step of 1.1 s at 101 and at 41 frames, force by the reading "disc" of a smooth synthetic area,
E* 6.8 MPa, Ornstein-Uhlenbeck noise of 100 N and the correlation times of the table. An interval of 95 % is right
when it holds the true value in 93 to 97 % of the runs. Fewer runs where a lag or a threshold is free besides, without
the bootstrap, because each is a search.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
CASES = ((101, 0.02), (101, 0.05), (41, 0.05), (41, 0.1))
"""Frames and correlation time [s]."""

FREED = (("lag", 41, 0.02), ("lag", 41, 0.05), ("threshold", 41, 0.02), ("threshold", 41, 0.05))
"""What is free besides E*, frames (those that a lag moves out of the recording are not compared: 35 are), correlation
time [s]."""

NOISE = 100.0  # N
DECADES = (1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11)


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.knee.modulus", description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=2000)
    parser.add_argument("--runs-freed", type=int, default=300)
    parser.add_argument("--replicates", type=int, default=400)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions
    from tests.identify.synthetic_contact import coverage

    exact = noise_free()
    print(json.dumps(exact), flush=True)
    rows = []
    for frames, tau in CASES:
        begun = time.process_time()
        told = coverage(options.runs, frames, NOISE, tau, options.replicates, options.seed)
        seconds = (time.process_time() - begun) / options.runs
        rows.append(
            {"frames": frames, "tau_s": tau, "runs": options.runs, **told, "seconds_per_run": round(seconds, 4)}
        )
        print(json.dumps(rows[-1]), flush=True)
    freed = [coverage_with(name, frames, tau, options.runs_freed, options.seed) for name, frames, tau in FREED]
    report = {
        "machine": machine(), "versions": versions({"scipy"}), "seed": options.seed, "noise_N": NOISE,
        "replicates": options.replicates, "noise_free_largest_relative_error": exact, "coverage": rows,
        "coverage_with_more_free": freed,
    }  # fmt: skip
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "modulus.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def noise_free() -> dict[str, float]:
    """Largest relative error of E* by reading, over eight decades of it, from starts over ten."""
    from geocontact.elastic_modulus.area_force import MODULUS
    from geocontact.elastic_modulus.identify import fitted, modulus_parameter
    from tests.identify.synthetic_contact import READING, synthetic_model

    worst = {}
    for reading in READING:
        model = synthetic_model(reading)
        true = [0.68 * decade for decade in DECADES]
        found = [fitted(model, model.force({MODULUS: e}), (modulus_parameter(),)).values[MODULUS] for e in true]
        worst[reading] = max(abs(f / e - 1.0) for f, e in zip(found, true, strict=True))
    return worst


def coverage_with(name: str, frames: int, tau: float, runs: int, seed: int) -> dict[str, object]:
    """Share of runs whose profile intervals hold E* and the other number; true lag 0.013 s, true threshold 3.3 mm."""
    import numpy as np

    from geocontact.data.parameter import Parameter
    from geocontact.elastic_modulus.area_force import MODULUS
    from geocontact.elastic_modulus.identify import fitted, modulus_parameter
    from geocontact.identify.intervals.profile_likelihood import profile
    from geocontact.identify.noise.autocorrelation import autocorrelation_of
    from tests.identify.synthetic_contact import TRUE, coloured, synthetic_model

    free, true = {
        "lag": (Parameter("lag", "s", 0.0, -0.06, 0.06), 0.013),
        "threshold": (Parameter("threshold", "m", 4e-3, 1e-3, 5e-3), 3.3e-3),
    }[name]
    edge = int(np.ceil(0.06 / 1.1 * (frames - 1)))
    model = synthetic_model(frames=frames, inner=slice(edge, -edge))
    force = model.force({MODULUS: TRUE, name: true})
    rng, held, opened = np.random.default_rng([seed, frames]), np.zeros(2), 0
    parameters = (modulus_parameter(), free)
    for _ in range(runs):
        measured = force + coloured(model.frames, NOISE, tau, rng)
        fit = fitted(model, measured, parameters, starts=0)
        memory = autocorrelation_of(model.frames, fit.residuals[0][:, 0], fit.jacobian[0][:, 0, :])
        ends = [
            profile(model.predict, measured, model.frames, parameters, fit, memory, each, points=2)
            for each in (MODULUS, name)
        ]
        held += [p.lower <= value <= p.upper for p, value in zip(ends, (TRUE, true), strict=True)]
        opened += any(p.lower_open or p.upper_open for p in ends)
    row = {
        "free": name, "frames": len(model.frames), "tau_s": tau, "runs": runs, "E*": held[0] / runs,
        name: held[1] / runs, "open_on_a_side": opened / runs,
    }  # fmt: skip
    print(json.dumps(row), flush=True)
    return row


if __name__ == "__main__":
    main()
