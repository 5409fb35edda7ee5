"""Both legs: what their equations cost, and how long a walk's own torques make the walk again.

    python -m benchmarks.prosthesis.both_sides [--person 0] [--setting medium]

A synthetic walk by given angles (only the pelvis' advance and height, socket and keel are found), its forces by inverse
dynamics, and the walk that these forces make with every coordinate free. Printed are operations, seconds to build and
compile, CPU time of a step, and errors over time: the largest turn [deg], shift [mm] and force of the prosthetic foot
over body weight up to then, and the rate at which the turn's error grows. Once with the load under the intact foot
given, once with spheres there.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.recorded_steps import played_back
from geocontact.below_knee_prosthesis.both_sides.walk import (
    FREE,
    GivenWalk,
    accelerations_by_angles,
    coordinate_names,
    driven_stepper,
    driving_forces,
    equations_of_both,
    passive,
    walk_by_angles,
    walk_by_forces,
)
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.dynamics.recorded_inputs import recorded_inputs
from geocontact.dynamics.rosenbrock import rosenbrock_step
from meshes.amputee import true_amputee
from meshes.amputee_walk import amputee_walk, amputee_walk_on_spheres
from meshes.gait_persons import PARTICIPANTS, STANCE

RUNS = ((1e-3, 1e-6), (2.5e-4, 1e-7))
"""Steps of the samples [s] and tolerances of both walks."""
SPANS = {
    False: {"single support": (0.16, 0.56), "from double support on": (-0.08, 0.56)},
    True: {"as the intact foot leaves": (0.16, 0.68), "from double support on": (-0.05, 0.76)},
}
"""s, at medium stiffness, without and with spheres under the intact foot."""
EVERY = 0.04
"""s; of a row."""
LOST = 90.0
"""deg; beyond it nothing is told."""


def sizes(truth: Amputee) -> dict[str, dict[str, float]]:
    """Operations of accelerations and of a step."""
    told = {}
    names = coordinate_names(truth)
    given = [name for name in names if name not in FREE and name not in passive(names)]
    driven = [name for name in names if name not in passive(names)]
    for label, chosen in (("angles given", {"prescribed": given}), ("forces given", {"driven": driven})):
        before = time.process_time()
        equations = equations_of_both(truth, **chosen)
        step = rosenbrock_step(equations)
        spent = time.process_time() - before
        count = equations.accelerations().n_instructions()
        told[label] = {
            "coordinates": len(equations.names),
            "accelerations": count,
            "step": step.n_instructions(),
            "built_s": spent,
        }
        print(
            f"{label}: {len(equations.names)} coordinates found, {count} operations of accelerations, "
            f"{step.n_instructions()} of a step, built in {spent:.1f} s"
        )
    return told


def again(truth: Amputee, given: GivenWalk, every: float, tolerance: float, spheres: bool) -> list[dict[str, Any]]:
    """How far the walk by forces is from that by angles, printed."""
    told = []
    before = time.process_time()
    walk = walk_by_angles(truth, given, np.arange(-0.08, 0.76, every), intact_on_spheres=spheres, tolerance=tolerance)
    spent = time.process_time() - before
    ground = recorded_inputs(given.time, given.ground).at(walk.time)
    fast = accelerations_by_angles(truth, given, walk, intact_on_spheres=spheres)
    forces = driving_forces(truth, walk, fast, ground, intact_on_spheres=spheres)
    print(f"samples of {1e3 * every:g} ms, tolerance {tolerance:g}: by angles {walk.steps} steps in {spent:.2f} s CPU")
    stepper = driven_stepper(truth, intact_on_spheres=spheres)
    for label, (start, stop) in SPANS[spheres].items():
        on = (walk.time >= start - 1e-9) & (walk.time <= stop + 1e-9)
        part = walk.part(start, stop)
        before = time.process_time()
        other = walk_by_forces(
            truth, stepper, part, part.time, ground[on], forces[on], intact_on_spheres=spheres, tolerance=tolerance
        )
        spent = time.process_time() - before
        found = played_back(part, other, truth.mass)
        since, turn, shift, force = found.since, found.turn, found.shift, found.force
        rate, held = found.growth, found.held
        print(
            f"  {label}: {other.steps} steps, {1e6 * spent / other.steps:.0f} us CPU each, growth {rate:.0f}/s, "
            f"within 0.5 deg and 2 % BW for {held:.2f} s of {since[-1]:.2f} s"
        )
        row: dict[str, Any] = {"spheres": spheres, "every": every, "tolerance": tolerance, "span": label}
        row |= {"steps": other.steps, "us_per_step": 1e6 * spent / other.steps, "growth": float(rate)}
        row |= {"held_s": float(held), "of_s": float(since[-1])}
        for when in np.arange(EVERY, since[-1] + 1e-9, EVERY):
            k = min(int(np.searchsorted(since, when)), len(since) - 1)
            if turn[k] > LOST:
                break
            print(f"    {since[k]:.2f} s {turn[k]:12.3g} deg {shift[k]:10.3g} mm {100.0 * force[k]:10.3g} % BW")
            row |= {"at_s": float(since[k]), "turn_deg": float(turn[k]), "shift_mm": float(shift[k])}
            row |= {"force_bw": float(force[k])}
        told.append(row)
    return told


def main() -> None:
    """Print figures; benchmarks/results/prosthesis_both_sides.json."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--person", type=int, default=0)
    parser.add_argument("--setting", default="medium")
    asked = parser.parse_args()
    truth = true_amputee(PARTICIPANTS[asked.person], vsf_foot(), fulcrum_of(asked.setting, "pinned"))
    figures: dict[str, Any] = {"sizes": sizes(truth), "again": []}
    before = time.perf_counter()
    driven_stepper(truth)
    figures["compiled_s"] = time.perf_counter() - before
    print(f"step by forces compiled or found in {figures['compiled_s']:.0f} s")
    lasting = STANCE[asked.setting]
    walks = {False: amputee_walk(truth, lasting)[0], True: amputee_walk_on_spheres(truth, lasting)}
    for spheres, given in walks.items():
        print("the intact foot on spheres" if spheres else "the load of the intact foot given", flush=True)
        for every, tolerance in RUNS:
            figures["again"] += again(truth, given, every, tolerance, spheres)
    write_results("prosthesis_both_sides", vars(asked), figures, {"casadi"})


if __name__ == "__main__":
    main()
