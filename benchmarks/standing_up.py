"""Contacts calibrated on synthetic trials of standing up: `python -m benchmarks.standing_up [PART …] [--noises 20]`.

Parts: coverage (how often intervals of 95 % hold what was planted, over noises), nodes (the same estimates on 50, 100
and 200 nodes a second, with their times), starts (success from 20 random starts). Everything is synthetic; truth and
calibration share their equations.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parent
PARTS = ("coverage", "nodes", "starts")
NODES = (50.0, 100.0, 200.0)


def main() -> None:
    """Measure, print, write the JSON; parts that were not asked for stay as they were."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing_up", description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", default=PARTS, metavar="PART")
    parser.add_argument("--noises", type=int, default=20)
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    options.out.mkdir(parents=True, exist_ok=True)
    file = options.out / "standing_up.json"
    report: dict[str, Any] = json.loads(file.read_text("utf-8")) if file.is_file() else {}
    report |= {"machine": machine(), "versions": versions({"casadi", "numpy", "scipy"})}
    for part in options.parts:
        found = {"coverage": coverage, "nodes": nodes, "starts": starts}[part](options)
        report[part] = found
        file.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
        print(json.dumps({part: found}, indent=2), flush=True)


def calibrated(study: Any, nodes_a_second: float = 30.0, start: Any = None, free: Any = None) -> dict[str, Any]:
    """Phase A of all trials of a study: what the search found, how long it took, what is told."""
    import numpy as np

    from geocontact.dynamics.collocation.solve import SolverOptions, solve
    from geocontact.standing_up.contact_numbers import contact_numbers
    from geocontact.standing_up.feet import SOUGHT, feet_on_ground
    from geocontact.standing_up.phase_a import phase_a

    feet = feet_on_ground(study.subject)
    names = SOUGHT if free is None else free
    phase = phase_a(feet, study.subject, study.trials, study.noise, free=names, start=start)
    meshes = tuple(np.linspace(0.0, 1.0, round(nodes_a_second * float(t.time[-1])) + 1) for t in study.trials)
    began = time.process_time()
    found = solve(phase.control, SolverOptions("radau", 4, 1, 1e-7, 300), meshes=meshes)
    searched = time.process_time() - began
    told = contact_numbers(phase, found) if found.solved else None
    return {"phase": phase, "found": found, "told": told, "seconds": searched, "feet": feet}


def certified(run: dict[str, Any]) -> list[dict[str, Any]]:
    """Certificates of the motions."""
    from geocontact.standing_up.chain import TURNING
    from geocontact.standing_up.judged import judged

    seen = judged(run["feet"].equations, range(3), TURNING, run["phase"], run["found"])
    return [vars(each.certificate) for each in seen]


def coverage(options: argparse.Namespace) -> dict[str, Any]:
    """Deviations from what was planted over standard deviations, for each noise; certificates of all motions."""
    import numpy as np

    from geocontact.standing_up.feet import FOOT_PARAMETERS, SOUGHT
    from geocontact.standing_up.synthetic_study import synthetic_study

    parts, seconds, passed, residuals = [], [], [], []
    for noise in range(options.noises):
        study = synthetic_study(seed=noise + 1)
        run = calibrated(study)
        if run["told"] is None:
            print(f"noise {noise + 1}: {run['found'].ending}", flush=True)
            continue
        after = np.array([each.after for each in run["told"].numbers])
        parts.append((run["found"].p - study.planted) / np.where(after > 0.0, after, np.inf))
        seconds.append(run["seconds"])
        seen = certified(run)
        passed.append([each["converged"] for each in seen])
        residuals.append([(each["force"], each["moment"]) for each in seen])
        print(f"noise {noise + 1}: {np.round(parts[-1], 2)}, {seconds[-1]:.1f} s, {passed[-1]}", flush=True)
    off = np.array(parts)
    names = [each.name for each in FOOT_PARAMETERS]
    off, names = off[:, [name in SOUGHT for name in names]], list(SOUGHT)
    return {
        "noises": options.noises,
        "solved": len(parts),
        "held by the 95 % interval": dict(zip(names, (np.abs(off) <= 1.96).mean(axis=0).tolist(), strict=True)),
        "mean in standard deviations": dict(zip(names, off.mean(axis=0).tolist(), strict=True)),
        "spread in standard deviations": dict(zip(names, off.std(axis=0).tolist(), strict=True)),
        "cpu seconds": {"median": float(np.median(seconds)), "most": float(np.max(seconds))},
        "motions certified": f"{int(np.sum(passed))} of {np.size(passed)}",
        "largest residual [N], [N m]": np.max(np.array(residuals), axis=(0, 1)).tolist(),
    }


def nodes(options: argparse.Namespace) -> list[dict[str, Any]]:
    """The shipped study on three meshes."""
    from geocontact.standing_up.synthetic_study import synthetic_study

    study, rows = synthetic_study(), []
    for count in NODES:
        run = calibrated(study, count)
        row = {"nodes a second": count, "ending": run["found"].ending, "cpu seconds": run["seconds"]}
        row |= {"iterations": run["found"].iterations, "parameters": {}}
        if run["told"] is not None:
            row["parameters"] = {n.name: [n.value, n.lower, n.upper] for n in run["told"].numbers}
            row["residual [N], [N m]"] = [max(c[k] for c in certified(run)) for k in ("force", "moment")]
        rows.append(row)
        print(json.dumps(row), flush=True)
    return rows


def starts(options: argparse.Namespace) -> dict[str, Any]:
    """Starts drawn from what is believed, of the shipped study."""
    import numpy as np

    from geocontact.standing_up.contact_parameter import usual
    from geocontact.standing_up.feet import FOOT_PARAMETERS
    from geocontact.standing_up.synthetic_study import synthetic_study

    study, rng = synthetic_study(), np.random.default_rng(20)
    sd = np.array([each.sd for each in FOOT_PARAMETERS])
    ends = []
    for _ in range(options.starts):
        run = calibrated(study, start=usual(FOOT_PARAMETERS) + sd * rng.normal(size=len(sd)))
        ends.append((run["found"].solved, run["found"].objective, run["seconds"]))
        print(ends[-1], flush=True)
    best = min(objective for solved, objective, _ in ends if solved)
    return {
        "starts": len(ends),
        "solved": sum(solved for solved, _, _ in ends),
        "in the best minimum": sum(solved and objective < best * 1.001 for solved, objective, _ in ends),
        "objectives": sorted(round(objective, 4) for solved, objective, _ in ends if solved),
        "cpu seconds": float(np.median([seconds for _, _, seconds in ends])),
    }


if __name__ == "__main__":
    main()
