"""The elbow's identification on synthetic recordings: `python -m benchmarks.elbow.identification [--runs 200]`.

The paper's design: six locked trials of 60 s, multisine of 0.05 to 0.35 Hz, 1 kHz, 12 bits; its five numbers are the
truth. Noise is an Ornstein-Uhlenbeck force of 0.8 N and 0.3 s. Told are the time of a fit to the binned means from the
paper's start, and how often intervals of 95 % hold the truth: k, x, y with l and z known; all five with priors on l and
z, the true lengths drawn from the priors; k, x, y with offsets that change from trial to trial, which the intervals
do not know of; k where a free joint sets the scale; and, nothing known, what no scale changes: k l, x/l, y/l, z/l, by
profile only, within the outermost ends and within one of the parts.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
PRIOR = 5e-3  # m, standard deviation of the priors on l and z
DONNING = 2e-3  # m
STROKE = (-0.010, 0.060)  # m, of the compensation joint while it is free
FITS = 300


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.elbow.identification", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--runs-others", type=int, default=60)
    parser.add_argument("--runs-free", type=int, default=100)
    parser.add_argument("--replicates", type=int, default=200)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--times", action="store_true", help="only the times again, beside what the file holds")
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    timed = seconds_per_fit(options.seed)
    print(json.dumps(timed), flush=True)
    if options.times:
        held = json.loads((options.out / "elbow.json").read_text(encoding="utf-8"))
        write(options.out, {**held, "fit": timed, "machine_of_fit": machine()})
        return
    report: dict[str, object] = {
        "machine": machine(), "versions": versions({"scipy", "numba"}), "seed": options.seed, "fit": timed,
        "replicates": options.replicates, "prior_sd_mm": PRIOR * 1e3, "donning_sd_mm": DONNING * 1e3,
    }  # fmt: skip
    rows = []
    options.out.mkdir(parents=True, exist_ok=True)
    for name, runs in (
        ("l and z known", options.runs), ("priors on l and z", options.runs_others),
        ("l and z known, donning", options.runs_others),
    ):  # fmt: skip
        rows.append(coverage(name, runs, options.replicates, options.seed))
        write(options.out, {**report, "coverage": rows})
    report["scale by the free joint"] = [
        scaled(options.runs_others, options.seed, donning) for donning in (0.0, DONNING)
    ]
    write(options.out, {**report, "coverage": rows, "scale free": ratios(options.runs_free, options.seed)})


def write(folder: Path, report: dict[str, object]) -> None:
    """The JSON so far."""
    (folder / "elbow.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def seconds_per_fit(seed: int) -> list[dict[str, object]]:
    """Processor time of one search from the paper's start over bins of 2 degrees, and of the command's whole fit.

    The whole fit searches from several starts and tells which minima fit nearly as well; binning and intervals are not
    in it.
    """
    import numpy as np

    from geocontact.axis_misalignment.bins import binned
    from geocontact.axis_misalignment.least_squares import estimated, problem_of
    from geocontact.axis_misalignment.synthetic import PAPER, Design
    from tests.systems.elbow_trials import parameters, trials

    found = binned(trials(PAPER, Design(), seed), np.radians(2.0))
    rows = []
    for name, known in (("three", ("l", "z")), ("five", ())):
        for kind, data in (("all trials together", pooled(found)), ("each trial apart", found)):
            problem = problem_of(data, parameters({n: PAPER[n] for n in known}), {})
            start = np.array([problem.parameters[k].start for k in problem.free])
            problem.searched(start)
            spent = []
            for _ in range(FITS):
                begun = time.process_time()
                search = problem.searched(start)
                spent.append(time.process_time() - begun)
            whole = []
            for _ in range(FITS // 10):
                begun = time.process_time()
                estimated(problem)
                whole.append(time.process_time() - begun)
            rows.append({
                "numbers": name, "bins": kind, "means": len(problem.force), "steps": search.steps,
                "milliseconds": round(1e3 * float(np.median(spent)), 3),
                "milliseconds_95": round(1e3 * float(np.quantile(spent, 0.95)), 3),
                "milliseconds_whole": round(1e3 * float(np.median(whole)), 3),
            })  # fmt: skip
    return rows


def pooled(data):
    """The same bins, as if all trials were one: the paper's 42 points."""
    from dataclasses import replace

    import numpy as np

    visits = replace(data.visits, trial=np.zeros_like(data.visits.trial))
    return replace(data, visits=visits, cells=visits.cells())


def coverage(name: str, runs: int, replicates: int, seed: int) -> dict[str, object]:
    """Share of runs whose intervals hold the true numbers, by profile and by wild bootstrap."""
    import numpy as np
    from scipy.stats import norm, qmc

    from geocontact.axis_misalignment.bins import binned
    from geocontact.axis_misalignment.least_squares import Prior, estimated, problem_of
    from geocontact.axis_misalignment.synthetic import PAPER, Design
    from geocontact.axis_misalignment.uncertainty import covariance, profiled, wild_bootstrap
    from tests.systems.elbow_trials import parameters, trials

    by_prior = name.startswith("priors")
    design = Design(donning=DONNING if name.endswith("donning") else 0.0)
    priors = {n: Prior(PAPER[n], PRIOR) for n in "lz"} if by_prior else {}
    held: dict[str, list[tuple[bool, bool]]] = {}
    widths: dict[str, list[float]] = {}
    begun = time.process_time()
    drawn_from = qmc.LatinHypercube(2, rng=seed).random(runs)  # evenly over the priors: 60 draws at random are uneven
    for run in range(runs):
        apart = norm.ppf(drawn_from[run])
        truth = {**PAPER, **{n: p.mean + p.sd * float(apart[k]) for k, (n, p) in enumerate(priors.items())}}
        data = binned(trials(truth, design, [seed, run, by_prior]), np.radians(2.0))
        known = {} if by_prior else {n: PAPER[n] for n in "lz"}
        e = estimated(problem_of(data, parameters(known), priors), starts=2)
        c = covariance(data, e)
        drawn = np.percentile(wild_bootstrap(data, e, replicates, run), (2.5, 97.5), axis=0)
        for k, n in enumerate(e.problem.names):
            p = profiled(e, c, n, points=2)
            held.setdefault(n, []).append(
                (p.lower <= truth[n] <= p.upper, bool(drawn[0, k] <= truth[n] <= drawn[1, k]))
            )
            widths.setdefault(n, []).append(p.upper - p.lower)
    seconds = (time.process_time() - begun) / runs
    shares = {n: [float(share) for share in np.mean(pairs, axis=0)] for n, pairs in held.items()}
    row: dict[str, object] = {
        "case": name, "runs": runs, "profile likelihood": {n: s[0] for n, s in shares.items()},
        "wild bootstrap": {n: s[1] for n, s in shares.items()},
        "median width": {n: float(np.median(w)) for n, w in widths.items()}, "seconds_per_run": round(seconds, 3),
    }  # fmt: skip
    print(json.dumps(row), flush=True)
    return row


def ratios(runs: int, seed: int) -> dict[str, object]:
    """Share of runs whose profile intervals hold the true ratios where nothing sets the scale, and both signs of x."""
    import numpy as np

    from geocontact.axis_misalignment.bins import binned
    from geocontact.axis_misalignment.least_squares import estimated, problem_of
    from geocontact.axis_misalignment.synthetic import PAPER, Design
    from geocontact.axis_misalignment.uncertainty import covariance, profiled, with_link_held
    from tests.systems.elbow_trials import parameters, trials

    held: dict[str, list[tuple[bool, bool]]] = {}
    signs = []
    begun = time.process_time()
    for run in range(runs):
        data = binned(trials(PAPER, Design(), [seed, run, 2]), np.radians(2.0))
        e = with_link_held(estimated(problem_of(data, parameters({}), {})))
        c = covariance(data, e)
        factor = e.named["l"] / PAPER["l"]
        for n in e.problem.names:
            p = profiled(e, c, n, points=2)
            truth = PAPER[n] / factor if n == "k" else PAPER[n] * factor
            inside = any(low <= truth <= high for low, high in p.parts)
            held.setdefault(n, []).append((bool(p.lower <= truth <= p.upper), inside))
            if n == "x":
                signs.append(bool(p.lower < 0.0 < p.upper))
    keys = {"k": "k·l", "x": "x/l", "y": "y/l", "z": "z/l"}
    row: dict[str, object] = {
        "case": "nothing known", "runs": runs, "seconds_per_run": round((time.process_time() - begun) / runs, 3),
        "profile likelihood": {keys[n]: float(np.mean([hull for hull, _ in hits])) for n, hits in held.items()},
        "one of its parts": {keys[n]: float(np.mean([inside for _, inside in hits])) for n, hits in held.items()},
        "sign of x not told": float(np.mean(signs)),
    }  # fmt: skip
    print(json.dumps(row), flush=True)
    return row


def scaled(runs: int, seed: int, donning: float) -> dict[str, object]:
    """Share of runs whose profile interval holds the true k, and its spread, where a free joint sets the scale."""
    import numpy as np

    from geocontact.axis_misalignment.bins import binned
    from geocontact.axis_misalignment.compensation import (
        bin_means,
        displacement_scale,
        recorded_stroke,
        stiffness_by_displacement,
    )
    from geocontact.axis_misalignment.least_squares import estimated, problem_of
    from geocontact.axis_misalignment.synthetic import PAPER, Design
    from geocontact.axis_misalignment.uncertainty import covariance, profiled
    from tests.systems.elbow_trials import parameters, trials

    design, width = Design(donning=donning), np.radians(2.0)
    found = np.empty((runs, 4))
    for run in range(runs):
        locked = binned(trials(PAPER, design, [seed, run, 3]), width)
        free = binned(trials(PAPER, design, [seed, run, 4], stroke=STROKE), width)
        stroke = recorded_stroke(bin_means(free))
        scale = displacement_scale([bin_means(free.only(k)) for k in range(len(free.names))], stroke, width)
        e = estimated(problem_of(locked, parameters({}), {}, scale))
        p = profiled(e, covariance(locked, e), "k", points=2)
        each = [bin_means(locked.only(k)) for k in range(len(locked.names))]
        slope = stiffness_by_displacement(each, stroke, width).value
        found[run] = p.lower <= PAPER["k"] <= p.upper, p.upper - p.lower, e.named["k"], slope
    row: dict[str, object] = {
        "runs": runs, "donning_sd_mm": donning * 1e3, "profile likelihood": float(found[:, 0].mean()),
        "median width": float(np.median(found[:, 1])), "sd of k": float(found[:, 2].std()),
        "sd of k by the slope of the locked force": float(found[:, 3].std()),
    }  # fmt: skip
    print(json.dumps(row), flush=True)
    return row


if __name__ == "__main__":
    main()
