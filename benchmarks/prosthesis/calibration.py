"""Calibration of the sole: `python -m benchmarks.prosthesis.calibration [P1 ...] [--samples N] [--trials N]`.

Truth is a finer foot (`synthetic.trial`): more joints, twice the rows of spheres. Numbers are found along poses from
markers, with the keel without inertia, and judged by the simulation of the stance, which gets the other leg's force and
the recorded angles, as section 2.5 of the study. Two predictors without any model stand beside: the mean of the other
trials' plates, and another setting's plate. All data are synthetic. `--samples` draws that many random numbers beside.
Participants that are run by themselves take the place of their own in benchmarks/results/prosthesis_calibration.json.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from geocontact.analyses.prosthesis.ranges import TURNS
from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration, calibrate
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance, stance_from_markers
from geocontact.below_knee_prosthesis.calibration.sole_residuals import SoleResiduals
from geocontact.below_knee_prosthesis.calibration.whole_model import WholeResiduals
from geocontact.below_knee_prosthesis.evaluation import PlateStance, StanceErrors, longest_stance, stance_errors
from geocontact.below_knee_prosthesis.from_markers import Walked, as_right, of_side, standing_leg, walked
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.below_knee_prosthesis.leg_tree import LegMotion
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket, limb_in_socket
from geocontact.below_knee_prosthesis.simulate import Push, Stance, simulate_stance
from geocontact.data.body_segments import body_segments
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.identify.signals.agreement import agreement
from meshes.gait_persons import PARTICIPANTS, Walker
from meshes.gait_trial import GaitTrial, synthetic_trial

SETTINGS, TRIALS = ("medium", "low", "high"), 3
RESULTS = Path(__file__).resolve().parents[1] / "results" / "prosthesis_calibration.json"
CUTOFF, ANGLES_CUTOFF, GAP = 15.0, 6.0, 0.2
"""Hz; of the markers for the calibration, and of the angles for the simulation; s."""
CURVES = ("resultant", "vertical", "fore_aft", "impulse", "cop_ground")
AROUND = 0.1
"""s; simulated before and after the stance."""


@dataclass(frozen=True, eq=False)
class Recorded:
    """A trial as the calibration and as the simulation take it."""

    setting: str
    stance: RecordedStance
    seen: MarkerTrajectories
    fit: Walked
    push: Push
    plate: PlateStance


def recorded(trial: GaitTrial, foot: VariableStiffnessFoot) -> Recorded:
    """Of a right leg."""
    p = trial.person
    person = Person(p.mass, body_segments(p.sex))
    below = sole_numbers()["below"].value
    leg = standing_leg(as_right(trial.standing, p.side), person, foot.keel, below)
    seen = as_right(trial.walking, p.side)
    plate = PlateStance(trial.time, of_side(trial.own, p.side), of_side(trial.centre, p.side))
    fulcrum, length = fulcrum_of(trial.setting), foot.keel.length
    stance = stance_from_markers(seen, leg, plate, fulcrum, length, cutoff=CUTOFF, gap_limit=GAP)
    fit = walked(seen, leg, cutoff=ANGLES_CUTOFF, gap_limit=GAP)
    return Recorded(trial.setting, stance, seen, fit, Push(trial.time, of_side(trial.other, p.side)), plate)


def in_socket(one: Recorded, foot: VariableStiffnessFoot, span: tuple[float, float]) -> LimbInSocket:
    """The limb's motion and the stance along it on a foot, from one time to another [s]."""

    def along(motion: LegMotion) -> Stance:
        return simulate_stance(motion, foot, one.stance.fulcrum, one.push, span)

    return limb_in_socket(one.seen, one.fit, along, cutoff=ANGLES_CUTOFF, gap_limit=GAP, turns=TURNS)


def judged(one: Recorded, foot: VariableStiffnessFoot) -> StanceErrors:
    """The stance simulated on a foot, beside the plate."""
    span = longest_stance(one.plate.time, one.plate.force[:, 1])
    if span is None:
        raise ValueError("a plate without a stance")
    time = one.fit.motion.time
    ends = max(span[0] - AROUND, time[2]), min(span[1] + AROUND, time[-3])
    return stance_errors(in_socket(one, foot, (float(ends[0]), float(ends[1]))).stance, one.plate)


def best_of_random(residuals: SoleResiduals | WholeResiduals, samples: int, seed: int = 1) -> float:
    """Least cost of numbers drawn evenly in their logarithms between the bounds."""
    rng, reach = np.random.default_rng(seed), residuals.zones.reach
    lowest = np.inf
    for _ in range(samples):
        off = residuals(reach * rng.uniform(-1.0, 1.0, len(reach)))
        lowest = min(lowest, 0.5 * float(off @ off))
    return lowest


def trivial(
    found: Mapping[str, StanceErrors], name: str, curve: str
) -> tuple[tuple[float, float], tuple[float, float]]:
    """R² and RMSE of the mean of the other trials' plates, and of another setting's plate."""
    measured = found[name].curves[curve][1]
    others = [each.curves[curve][1] for other, each in found.items() if other != name]
    setting = name.partition("_")[0]
    strange = next(each.curves[curve][1] for other, each in found.items() if not other.startswith(setting))
    told = [agreement(model, measured, 1.0, 0.0) for model in (np.mean(others, axis=0), strange)]
    return (told[0].r2, told[0].rmsd), (told[1].r2, told[1].rmsd)


def numbers_table(found: SoleCalibration) -> None:
    """Print the numbers with their intervals."""
    apart = found.knowledge.told_apart
    print(
        f"  {apart.verdict}, condition {apart.condition:.3g}; residuals remember {found.knowledge.memory.typical:.3f} s"
    )
    for each in found.knowledge.numbers:
        print(
            f"  {each.name:22s} {each.value:10.4g} {each.lower:10.4g} {each.upper:10.4g} {each.unit:8s}{each.verdict}"
        )


def transfer_table(trials: Mapping[str, Recorded], foot: VariableStiffnessFoot) -> dict[str, Any]:
    """Errors of each trial on a foot, with what needs no model beside; printed."""
    found = {}
    for name, one in trials.items():
        try:
            found[name] = judged(one, foot)
        except ArithmeticError as error:
            print(f"  {name}: {error}")
    rows: dict[str, Any] = {}
    for curve in CURVES:
        print(f"  {curve}: R² and RMSE; of the mean of the others; of another setting")
        for name, each in found.items():
            r2, off = each.table[curve]
            (mean_r2, mean_off), (strange_r2, strange_off) = trivial(found, name, curve)
            own = {"r2": r2, "rmse": off, "mean_r2": mean_r2, "mean_rmse": mean_off}
            rows.setdefault(name, {})[curve] = own | {"another_r2": strange_r2, "another_rmse": strange_off}
            plain = f"{mean_r2:7.3f} {mean_off:6.3f}   {strange_r2:7.3f} {strange_off:6.3f}"
            print(f"    {name:10s} {r2:7.3f} {off:6.3f}   {plain}")
    late = [each.stance[0] - each.stance[1] for each in found.values()]
    print(f"  stance longer by {np.mean(late):+.3f} s (SD {np.std(late):.3f})")
    return {"trials": rows, "longer_s": float(np.mean(late)), "longer_sd_s": float(np.std(late))}


def participant(person: Walker, samples: int, trials: int) -> dict[str, Any]:
    """All of one person."""
    foot = vsf_foot()
    taken = {
        f"{setting}_{k}": recorded(synthetic_trial(person, setting, k), foot)
        for setting in SETTINGS
        for k in range(1, trials + 1)
    }
    before, wall = time.process_time(), time.perf_counter()
    one = calibrate([taken["medium_1"].stance], foot)
    took, lasted = time.process_time() - before, time.perf_counter() - wall
    print(f"{person.name}, {person.mass} kg: calibrated on medium_1 in {took:.1f} s of processor ({lasted:.1f} s)")
    print(
        f"  cost {one.cost:.1f}, of the usual numbers {one.costs[0]:.1f} after linear turns; solved {one.solved} times"
    )
    told: dict[str, Any] = {"seconds": took, "wall_s": lasted, "cost": one.cost, "solved": one.solved}
    if samples:
        before = time.process_time()
        lowest = best_of_random(SoleResiduals.of([taken["medium_1"].stance], foot), samples)
        told["random"] = {"samples": samples, "cost": lowest, "seconds": time.process_time() - before}
        print(f"  best of {samples} random samples {lowest:.1f}, {time.process_time() - before:.1f} s of processor")
    numbers_table(one)
    print("usual numbers, not calibrated")
    told["usual"] = transfer_table(taken, foot)
    print("calibrated on medium_1 alone")
    told["medium_1"] = transfer_table(taken, one.foot)
    told["numbers"] = [asdict(each) for each in one.knowledge.numbers]
    several = calibrate([taken[f"{setting}_1"].stance for setting in SETTINGS], foot)
    print("calibrated on one trial of each setting")
    numbers_table(several)
    told["one of each setting"] = transfer_table(taken, several.foot)
    return told


def main(arguments: Sequence[str] | None = None) -> None:
    """Participants by name, all unless named; written as they are done."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("persons", nargs="*")
    parser.add_argument("--samples", type=int, default=0)
    parser.add_argument("--trials", type=int, default=TRIALS)
    told = parser.parse_args(arguments)
    figures = json.loads(RESULTS.read_text(encoding="utf-8"))["figures"] if RESULTS.is_file() else {}
    for each in PARTICIPANTS:
        if not told.persons or each.name in told.persons:
            figures[each.name] = participant(each, told.samples, told.trials)
            write_results("prosthesis_calibration", vars(told), figures)


if __name__ == "__main__":
    main()
