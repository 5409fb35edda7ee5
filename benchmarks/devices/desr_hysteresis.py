"""Loops of the real ankle by the keel's own hysteresis: `python -m benchmarks.devices.desr_hysteresis [--data FOLDER]`.

`below_knee_prosthesis.keel.Keel.hysteresis` is friction at any rate that is a share of the elastic moment, built up
over some curvature (Dahl). Here a loop is the elastic torque of `benchmarks.devices.desr_keel` at the setting, times 1
+ h z sign, z' = (u - |u| z) / reach along the recorded angle: six numbers, fitted to five settings, four predicted.
Beside it stand `Keel.friction`, which is as large at any bend and here grows with the stiffness, no hysteresis and the
viscous one, by the same code. Answers go to benchmarks/results/desr_hysteresis.json.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from benchmarks.devices import desr
from benchmarks.devices.desr_keel import PARAMETERS, build, loop_area, stiffness, torque
from benchmarks.machine import write_results
from geocontact.below_knee_prosthesis.keel.balance_kernel import rubbed
from geocontact.below_knee_prosthesis.keel.sections import SUPPORTS, Support
from geocontact.chain.system import System
from geocontact.data.trial import Trial
from geocontact.io.cases.gap_case import read_gap_case

MORE: dict[str, tuple[tuple[str, float, float, float], ...]] = {
    "none": (),
    "viscous": (("retardation", 0.01, 0.0, 10.0),),
    "friction": (("rubbing", 0.01, 0.0, 0.2), ("reach", 0.01, 1e-3, 0.2)),
    "hysteresis": (("share", 0.1, 0.0, 0.95), ("reach", 0.01, 1e-3, 0.2)),
}
"""Name, start and bounds of the numbers beside those of the spring: s; - and rad."""


def friction(angle: np.ndarray, reach: float) -> np.ndarray:
    """z along a recorded angle [rad], as the keel's hinges have it; 0 at the start."""
    z = np.zeros(len(angle))
    for k, step in enumerate(np.diff(angle), 1):
        z[k] = rubbed(float(step), float(z[k - 1]), reach)[0]
    return z


def simulated(support: Support, system: System, trial: Trial, values: dict[str, float]) -> np.ndarray:
    """Torque of a loop [N m]."""
    elastic = np.asarray(system.simulate(trial, {p.name: values[p.name] for p in PARAMETERS}))[:, 0]
    angle = trial.column("angle")
    if "retardation" in values:
        return np.asarray(elastic + values["retardation"] * np.gradient(elastic, trial.time))
    if "rubbing" in values:
        limit = values["rubbing"] * stiffness(support, {**values, "setting": trial.covariates["setting"]})
        return np.asarray(elastic + limit * friction(angle, values["reach"]))
    if "share" in values:
        return np.asarray(elastic + values["share"] * np.abs(elastic) * friction(angle, values["reach"]))
    return elastic


def compared(file: Path) -> dict[str, Any]:
    """Both supports with each kind."""
    with tempfile.TemporaryDirectory() as folder:
        case = read_gap_case(desr.write_case(file, Path(folder) / "case", desr.SYSTEMS["joint"]))
    told = {}
    for support in SUPPORTS:
        system = build(support, PARAMETERS, {}, case.tables)
        start: dict[str, float] = {}
        for kind, more in MORE.items():
            told[f"{support}; {kind}"], found = fitted(support, system, case.calibration, case.evaluation, more, start)
            start = start or found
    return told


def fitted(
    support: Support, system: System, calibration: Any, evaluation: Any, more: Any, begun: dict[str, float]
) -> tuple[dict[str, Any], dict[str, float]]:
    """Numbers; errors of torque [N m] and of work [J] at the settings that were not fitted to."""
    rows = [(p.name, begun.get(p.name, p.start), p.lower, p.upper) for p in PARAMETERS] + list(more)
    names, first, lower, upper = (list(column) for column in zip(*rows, strict=True))
    size = np.array([max(abs(b), 1e-3) for b in first])

    def off(x: np.ndarray) -> np.ndarray:
        values = dict(zip(names, x * size, strict=True))
        return np.concatenate(
            [simulated(support, system, trial, values) - torque(trial)[:, 0] for trial in calibration]
        )

    bounds = np.array(lower) / size, np.array(upper) / size
    best = least_squares(off, np.clip(np.array(first) / size, *bounds), bounds=bounds, x_scale=1.0)
    values = dict(zip(names, map(float, best.x * size), strict=True))
    errors, work = [], {}
    for trial in evaluation:
        model = simulated(support, system, trial, values)
        errors.append(model - torque(trial)[:, 0])
        work[trial.name] = (loop_area(trial, torque(trial)), loop_area(trial, model[:, None]))
    told = {
        "values": values,
        "fitted_N_m": float(np.sqrt(np.mean(best.fun**2))),
        "predicted_N_m": float(np.sqrt(np.mean(np.concatenate(errors) ** 2))),
        "work_off_J": float(sum(abs(two - one) for one, two in work.values())),
        "work_J": work,
    }
    return told, values


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    default = Path(os.environ.get("GEOCONTACT_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data")
    parser.add_argument("--data", type=Path, default=default)
    told = compared(parser.parse_args().data / desr.FILE)
    for name, one in told.items():
        numbers = ", ".join(f"{key} {value:.4g}" for key, value in one["values"].items())
        errors = f"fitted {one['fitted_N_m']:.2f}, predicted {one['predicted_N_m']:.2f} N m"
        print(f"{name:20}{errors}, work off {one['work_off_J']:.2f} J; {numbers}")
    write_results("desr_hysteresis", {}, told)


if __name__ == "__main__":
    main()
