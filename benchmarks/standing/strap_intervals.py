"""Strap intervals on trials by another model: `python -m benchmarks.standing.strap_intervals [--seeds N] [--out DIR]`.

Trials of `standing_other_world`, on spheres and on cushions, with noise; phase A, then B as the command has them, at 12
intervals a second. Then B again with the feet as planted, and with other sizes of the jerk: which of the two moves the
strap's numbers. Offsets are in parts of the standard deviation, without and with the shares of what is given.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
NODES = 12.0


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.strap_intervals", description=__doc__)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import as_json, machine, versions

    report: dict[str, Any] = {"machine": machine(), "versions": versions({"casadi", "numpy", "scipy"})}
    for name, cushions in (("spheres", False), ("cushions", True)):
        report[name] = measured(cushions, options.seeds)
        print(as_json({name: report[name]}, 2), flush=True)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "standing_strap_intervals.json").write_text(as_json(report, 2), encoding="utf-8")


def measured(cushions: bool, seeds: int) -> list[dict[str, Any]]:
    """One world, noise after noise."""
    from benchmarks.standing.other_world import World, own_trials

    world = World(cushions=cushions)
    true = own_trials(world)
    return [one_noise(world, true, seed) for seed in range(seeds)]


def one_noise(world: Any, true: Any, seed: int) -> dict[str, Any]:
    """Phase A, B as the command has it, and B with other feet and other jerk."""
    import numpy as np

    from geocontact.dynamics.collocation.solve import SolverOptions, solve
    from geocontact.standing_up.chain import FOOT_PARAMETERS, SOUGHT, Subject
    from geocontact.standing_up.contact_numbers import contact_numbers, held_covariance
    from geocontact.standing_up.exoskeleton import STRAP, with_exoskeleton
    from geocontact.standing_up.phase import FOOT_JERK, JOINT_JERK, standing_phase
    from geocontact.standing_up.phases import TRACKS_B, phase_a, phase_b
    from geocontact.standing_up.strap_sites import searched, usual
    from geocontact.standing_up.trials import LITTLE_ENERGY, StandingNoise, with_noise

    subject, noise = Subject(world.mass, world.height), StandingNoise()
    model, count = with_exoskeleton(subject), len(FOOT_PARAMETERS)
    trials = [with_noise(trial, model, noise, 100 * seed + k) for k, trial in enumerate(true)]
    meshes = tuple(np.linspace(0.0, 1.0, round(NODES * float(t.time[-1])) + 1) for t in trials)
    options = SolverOptions("radau", 3, 1, 1e-7, 200, 120.0)

    def solved(phase: Any, warm: Any = None) -> Any:
        found = solve(phase.control, options, meshes=meshes, warm=warm)
        if not found.solved:
            raise ArithmeticError(found.ending)
        return found

    in_a = phase_a(model, subject, trials, noise, free=SOUGHT)
    of_a = solved(in_a)
    known = held_covariance(contact_numbers(in_a, of_a), in_a.parameters)
    feet = of_a.p[:count]
    in_b = phase_b(model, subject, trials, noise, feet)
    of_b = solved(in_b)

    def row(phase: Any, found: Any, held: Any) -> dict[str, Any]:
        rows = {}
        told = [one for one in contact_numbers(phase, found, held=held).numbers if one.name in STRAP]
        for number, planted in zip(told, world.strap, strict=True):
            of = next(each for each in phase.parameters if each.name == number.name)
            off = of.searched(number.value) - of.searched(planted)
            ends = {"value": number.value, "lower": number.lower, "upper": number.upper}
            by = {"off by trials alone [sd]": off / number.by_trials, "off [sd]": off / number.after}
            inside = bool(number.lower <= planted <= number.upper)
            rows[number.name] = {**ends, "planted": planted, **by, "inside": inside}
        return rows

    found = {"as the command": row(in_b, of_b, known)}
    held_feet = {"feet as A found": feet}
    if not world.cushions:
        numbers = (world.modulus, world.heel, world.toe, world.bottom, world.radius, world.dissipation, world.friction)
        held_feet["feet as planted"] = searched(FOOT_PARAMETERS, numbers)
    for name, at in held_feet.items():
        for times in (1.0, 3.0):
            begin = np.r_[at, of_b.p[count:]]
            held = np.r_[at, usual(model.parameters[count:])]
            small = {"energy": LITTLE_ENERGY * model.energy**2}
            sizes = (times * FOOT_JERK, times * JOINT_JERK)
            phase = standing_phase(
                model,
                subject,
                trials,
                noise,
                free=STRAP,
                tracks=TRACKS_B,
                small=small,
                held=held,
                start=begin,
                jerk_sizes=sizes,
            )
            rows = row(phase, solved(phase, of_b), None)
            found[f"{name}, jerk times {times:g}"] = {of: one["off [sd]"] for of, one in rows.items()}
    return found


if __name__ == "__main__":
    main()
