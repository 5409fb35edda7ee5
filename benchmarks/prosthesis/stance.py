"""One stance of the prosthetic side: CPU time over the time it lasts, at a force within 1 % of body weight.

    python -m benchmarks.prosthesis.stance [--settings low medium high] [--persons 0 1] [--plain]

For each setting and person the invented course of `meshes.gait_course` is simulated with the foot of 24
spheres, at several tolerances; the reference is a tolerance a hundred times smaller than the smallest of them. Errors
are of the resultant ground reaction at 500 Hz over body weight: root mean square and largest, where either carries 20
N. Times are CPU seconds of `Stepper.simulate` alone, medians of `REPEATS`, with machine code and, with `--plain`,
without.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import asdict, dataclass

import numpy as np

from benchmarks.machine import write_results
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from meshes.gait_course import GaitCourse, course
from meshes.gait_persons import PARTICIPANTS, STANCE, true_leg

TOLERANCES = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5)
REFERENCE, REPEATS = 1e-7, 3


@dataclass(frozen=True)
class Timing:
    """One tolerance: steps, CPU seconds per second simulated, errors over body weight."""

    tolerance: float
    steps: int
    per_second: float
    rms: float
    most: float


def driven(person: int, setting: str) -> tuple[GaitCourse, float]:
    """The course and the fulcrum."""
    foot, fulcrum = vsf_foot(), fulcrum_of(setting, "pinned")
    leg = true_leg(PARTICIPANTS[person], sole_numbers()["below"].value)
    return course(leg, foot, fulcrum, STANCE[setting]), fulcrum


def timings(
    person: int, setting: str, *, machine_code: bool, tolerances: tuple[float, ...] = TOLERANCES
) -> list[Timing]:
    """Of one setting and person."""
    one, fulcrum = driven(person, setting)
    weight = PARTICIPANTS[person].mass * GRAVITY

    def run(tolerance: float) -> Stance:
        return simulate_stance(
            one.motion, vsf_foot(), fulcrum, one.push, one.span, tolerance=tolerance, machine_code=machine_code
        )

    reference = run(REFERENCE)
    lasting, found = one.span[1] - one.span[0], []
    for tolerance in tolerances:
        spent = []
        for _ in range(REPEATS):
            before = time.process_time()
            stance = run(tolerance)
            spent.append(time.process_time() - before)
        on = stance.on | reference.on
        own, exact = (np.linalg.norm(each.force[on], axis=1) / weight for each in (stance, reference))
        off = np.abs(own - exact)
        rms = float(np.sqrt(np.mean(off**2)))
        found.append(Timing(tolerance, stance.found.steps, float(np.median(spent)) / lasting, rms, float(off.max())))
    return found


def main() -> None:
    """Print a table; benchmarks/results/prosthesis_stance.json, with --plain prosthesis_stance_plain.json."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--settings", nargs="+", default=["low", "medium", "high"])
    parser.add_argument("--persons", nargs="+", type=int, default=[0, 1])
    parser.add_argument("--plain", action="store_true", help="without machine code")
    asked = parser.parse_args()
    figures = []
    print(f"{'person':8}{'setting':9}{'tolerance':>10}{'steps':>7}{'CPU/real':>10}{'rms [BW]':>10}{'max [BW]':>10}")
    for person in asked.persons:
        for setting in asked.settings:
            for one in timings(person, setting, machine_code=not asked.plain):
                name = PARTICIPANTS[person].name
                figures.append({"person": name, "setting": setting, **asdict(one)})
                row = f"{name:8}{setting:9}{one.tolerance:10.0e}{one.steps:7d}{one.per_second:10.3f}"
                print(f"{row}{one.rms:10.5f}{one.most:10.5f}", flush=True)
    write_results(f"prosthesis_stance{'_plain' * asked.plain}", vars(asked), figures, {"casadi"})


if __name__ == "__main__":
    main()
