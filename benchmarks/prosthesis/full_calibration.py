"""The sole on the whole model: `python -m benchmarks.prosthesis.full_calibration [P1 ...] [--samples N] [--trials N]`.

From the numbers that `prosthesis_calibration` finds along recorded poses with a keel without inertia, damped
Gauss-Newton steps on the simulated stance (inertia, socket, free pelvis) by exact derivatives, height and pitch of the
foot sought on besides. Both laws are judged by the simulation of all trials, the one that they were fitted to first,
the foot as each trial's own standing has it. All data are synthetic, of a finer foot.
`--samples` draws that many random numbers between the bounds and takes the least cost. Participants that are run by
themselves take the place of their own in benchmarks/results/prosthesis_full_calibration.json.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from benchmarks.prosthesis.calibration import (
    SETTINGS,
    TRIALS,
    Recorded,
    best_of_random,
    in_socket,
    recorded,
    transfer_table,
)
from geocontact.below_knee_prosthesis.calibration.calibrate import calibrate
from geocontact.below_knee_prosthesis.calibration.recorded_stance import WalkedStance
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration, calibrate_whole
from geocontact.below_knee_prosthesis.calibration.zone_parameters import PRIOR
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from meshes.gait_persons import PARTICIPANTS, Walker
from meshes.gait_trial import synthetic_trial

FITTED = "medium_1"
RESULTS = Path(__file__).resolve().parents[1] / "results" / "prosthesis_full_calibration.json"
CURVES = ("resultant", "fore_aft", "cop_ground")


def as_walked(one: Recorded, foot: VariableStiffnessFoot) -> WalkedStance:
    """The trial as the whole model takes it, the socket's motion on a foot out of its markers."""
    first = WalkedStance(one.stance, one.fit.motion, one.push)
    limb = in_socket(one, foot, (first.begin, float(one.stance.time[-1])))
    return replace(first, motion=limb.walked.motion)


def means(table: dict[str, Any]) -> dict[str, dict[str, float]]:
    """Root mean square errors: of the trial that was fitted to, and means over the others by setting."""
    rows = table["trials"]
    told = {"fitted": {curve: rows[FITTED][curve]["rmse"] for curve in CURVES}}
    for setting in SETTINGS:
        others = [row for name, row in rows.items() if name.startswith(setting) and name != FITTED]
        if others:
            told[setting] = {curve: float(np.mean([row[curve]["rmse"] for row in others])) for curve in CURVES}
    return told


def identifiable(found: WholeCalibration) -> dict[str, Any]:
    """Numbers with verdicts, singular values and condition of the sensitivities, memory of the residuals."""
    apart = found.knowledge.told_apart
    return {
        "numbers": [asdict(each) for each in found.knowledge.numbers],
        "told_apart": apart.verdict,
        "condition": apart.condition,
        "singular_values": apart.singular_values.tolist(),
        "memory_s": found.knowledge.memory.typical,
        "believed_one_sd_factor": {kind: factor for kind, (factor, _) in PRIOR.items()},
    }


def participant(person: Walker, samples: int, trials: int) -> dict[str, Any]:
    """All of one person."""
    foot = vsf_foot()
    names = [f"{setting}_{k}" for setting in SETTINGS for k in range(1, trials + 1)]
    taken = {name: recorded(synthetic_trial(person, name.split("_")[0], int(name[-1])), foot) for name in names}
    before = time.process_time()
    still = calibrate([taken[FITTED].stance], foot)
    between = time.process_time()
    stance = [as_walked(taken[FITTED], still.foot)]
    whole = calibrate_whole(stance, foot, still.at)
    took = time.process_time() - between
    told: dict[str, Any] = {"seconds_along_poses": between - before, "seconds_whole": took}
    told |= {"begun": whole.begun, "cost": whole.cost, "simulated": whole.residuals.solved} | identifiable(whole)
    told["converged"] = whole.converged
    print(f"{person.name}: {between - before:.0f} and {took:.0f} CPU s; cost {whole.begun:.1f}, then {whole.cost:.1f}")
    for number in whole.knowledge.numbers:
        print(f"  {number.name:22s} {number.value:10.4g} {number.lower:10.4g} {number.upper:10.4g} {number.verdict}")
    if samples:
        start = time.process_time()
        lowest = best_of_random(whole.residuals, samples)
        told["random"] = {"samples": samples, "cost": lowest, "seconds": time.process_time() - start}
        print(f"  best of {samples} random samples {lowest:.1f}, {time.process_time() - start:.0f} CPU s")
    for name, law in (("along poses", still.foot), ("whole", whole.foot)):
        print(name)
        told[name] = means(transfer_table(taken, law))
        print(f"  {told[name]}", flush=True)
    return told


def main(arguments: Sequence[str] | None = None) -> None:
    """Participants by name, all unless named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("persons", nargs="*")
    parser.add_argument("--samples", type=int, default=0)
    parser.add_argument("--trials", type=int, default=TRIALS)
    told = parser.parse_args(arguments)
    figures = json.loads(RESULTS.read_text(encoding="utf-8"))["figures"] if RESULTS.is_file() else {}
    for each in PARTICIPANTS:
        if not told.persons or each.name in told.persons:
            figures[each.name] = participant(each, told.samples, told.trials) | {"samples": told.samples}
            write_results("prosthesis_full_calibration", vars(told), figures, {"casadi"})


if __name__ == "__main__":
    main()
