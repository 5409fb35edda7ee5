"""Profiles of a calibrated sole's numbers: `python -m benchmarks.prosthesis.profiles [P1 ...] [--all]`.

The sole of a participant is calibrated on medium_1 along the recorded poses. Then each number that is known, with
`--all` each of the fifteen, is held at both ends of its interval of 95 % while the others are found again, and the sum
of squares, beliefs included, rises. Were the model linear in the numbers' logarithms it would rise by the square of the
distance over half the interval (one at an end that the bounds of the search have not cut off); `of_parabola` is the
rise over that. Below one the profile is flatter and the interval too narrow on that side, above one too wide. All data
are synthetic.
benchmarks/results/prosthesis_profiles.json, written as numbers are done.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from benchmarks.prosthesis.calibration import recorded
from geocontact.below_knee_prosthesis.calibration.calibrate import ENOUGH, SoleCalibration, calibrate
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.identify.optimise.bounded_gauss_newton import least
from meshes.gait_persons import PARTICIPANTS
from meshes.gait_trial import synthetic_trial

FITTED, ROUNDS = ("medium", 1), 6
"""The trial; evaluations in which the other numbers are found again, from where a linear model has them."""
HELD = 1e-9
"""Half of the width that is left to a number that is held."""


def held(found: SoleCalibration, k: int, value: float, covariance: np.ndarray) -> float:
    """Least sum of squares with one logarithm at a value."""
    residuals, reach = found.residuals, found.residuals.reach.copy()
    lower, upper = -reach, reach.copy()
    along = covariance[:, k] / covariance[k, k]
    start = np.clip(found.at + (value - found.at[k]) * along, lower, upper)
    start[k], lower[k], upper[k] = value, value - HELD, value + HELD
    return 2.0 * least(residuals, residuals.slope, start, lower, upper, ROUNDS, ENOUGH).cost


def ends(found: SoleCalibration, k: int, covariance: np.ndarray) -> dict[str, Any]:
    """Rises at both ends of the interval of one number."""
    number, half = found.knowledge.numbers[k], float(found.knowledge.half[k])
    usual = number.value / np.exp(found.logarithms[k])
    row: dict[str, Any] = {"number": number.name, "verdict": number.verdict, "value": number.value}
    for side, at in (("lower", number.lower), ("upper", number.upper)):
        away = float(np.log(at / number.value)) / half
        if abs(away) < 0.05:
            continue  # the number stands on its bound
        more = held(found, k, float(np.log(at / usual)), covariance) - 2.0 * found.cost
        rise = more * float(covariance[k, k]) / half**2
        row[side] = {"at": at, "halves": away, "rise": rise, "of_parabola": rise / away**2}
    return row


def main() -> None:
    """Print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("persons", nargs="*", default=["P1"])
    parser.add_argument("--all", action="store_true")
    asked = parser.parse_args()
    figures: dict[str, Any] = {}
    for person in (each for each in PARTICIPANTS if each.name in asked.persons):
        before = time.process_time()
        foot = vsf_foot()
        found = calibrate([recorded(synthetic_trial(person, *FITTED), foot).stance], foot)
        slope = found.residuals.slope(found.at)
        covariance = np.linalg.inv(slope.T @ slope)
        figures[person.name] = {"cost": found.cost, "numbers": []}
        for k, number in enumerate(found.knowledge.numbers):
            if number.verdict != "known" and not asked.all:
                continue
            row = ends(found, k, covariance)
            figures[person.name]["numbers"].append(row)
            told = [f"{side} {row[side]['of_parabola']:.2f}" for side in ("lower", "upper") if side in row]
            print(f"{person.name} {row['number']:24s} {row['verdict']:9s} {', '.join(told)}", flush=True)
            figures[person.name]["seconds"] = time.process_time() - before
            write_results("prosthesis_profiles", vars(asked), figures)


if __name__ == "__main__":
    main()
