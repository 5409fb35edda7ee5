"""An exoskeleton chosen for standing up, in a finer truth: `python -m benchmarks.standing.design [PART …]`.

Parts: slopes (derivatives of what a movement asks, and of the least of it, against problems solved again), gain (trials
of a finer simulation calibrated by the commands, an exoskeleton chosen on a trial that was not used, and its gain over
the share alone in the finer simulation beside the predicted interval), robust (what choosing for draws changes, on the
shipped trial). Everything is synthetic; numbers of the finer strap are invented. Seed 34.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
SAMPLES = HERE.parent / "meshes"
SEED = 34
VARY = "share,timing,place"
NAMES = ("strap", "knee", "energy", "shear")


def main() -> None:
    """Measure, print, write the JSON; parts that were not asked for stay as they were."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.design", description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", default=list(PARTS), metavar="PART")
    parser.add_argument("--draws", type=int, default=6)
    parser.add_argument("--resamples", type=int, default=0)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import as_json, machine, versions

    options.out.mkdir(parents=True, exist_ok=True)
    file = options.out / "standing_design.json"
    report: dict[str, Any] = json.loads(file.read_text("utf-8")) if file.is_file() else {}
    report |= {"machine": machine(), "versions": versions({"casadi", "numpy", "scipy"}), "seed": SEED}
    for part in options.parts:
        began = time.process_time()
        report[part] = PARTS[part](options)
        report[part]["cpu seconds of it all"] = time.process_time() - began
        file.write_text(as_json(report, 2), encoding="utf-8")
        print(json.dumps({part: report[part]}, indent=2), flush=True)


def gain(options: argparse.Namespace) -> dict[str, Any]:
    """Calibrated, chosen, and the same numbers in the finer simulation."""
    import numpy as np

    import geocontact as gc
    from benchmarks.standing.truth import PLANTED, finer_study, padded_strap
    from geocontact.dynamics.collocation.solve import SolverOptions
    from geocontact.standing_up.assisted_model import SHARE, assisted_model
    from geocontact.standing_up.assisted_movement import Movements
    from geocontact.standing_up.phase import PhaseProblem, judged
    from meshes.standing_files import synthetic_files

    warnings.simplefilter("ignore", gc.InputWarning)
    made = finer_study(SEED)
    with tempfile.TemporaryDirectory() as place:
        folders = {}
        for name, study in (("trials", made.trials), ("held_out", made.held_out)):
            folders[name] = Path(place) / name
            folders[name].mkdir()
            for file, text in synthetic_files(study).items():
                (folders[name] / file).write_text(text, encoding="utf-8")
        began = time.process_time()
        calibrated = gc.sit_to_stand.calibrate(
            folders["trials"] / "study.toml", nodes=45.0, resamples=options.resamples
        )
        calibrated.write(Path(place) / "cal")
        spent = {"calibrate": time.process_time() - began}
        began = time.process_time()
        chosen = gc.sit_to_stand.design(
            folders["held_out"] / "study.toml",
            parameters=Path(place) / "cal" / "parameters.csv",
            vary=VARY,
            draws=options.draws,
            front=4,
        )
        spent["design"] = time.process_time() - began
    truth = assisted_model(made.trials.subject, padded_strap)
    finer = Movements(truth, made.trials.subject, [made.true], SolverOptions("radau", 4, 1, 1e-8), 60.0)
    rows, left = {}, []
    for one in chosen.designs:
        p = np.r_[PLANTED, one.movement.found.p[SHARE:]]
        p[SHARE - 1] += (
            one.movement.found.p[SHARE - 1] - chosen.given.p[SHARE - 1]
        )  # moved as far as it was chosen to be
        seen = finer.at(p, slopes=False)
        phase = PhaseProblem(seen.problem, {}, (), ())
        (judgement,) = judged(truth.standing.stepper, truth.controlled, truth.standing.turning, phase, seen.found)
        left.append(float(judgement.force.max()))
        rows[one.name] = {
            "predicted": dict(zip(NAMES, one.movement.asked.sizes.tolist(), strict=True)),
            "finer": dict(zip(NAMES, seen.asked.sizes.tolist(), strict=True)),
            "predicted, true peaks": dict(zip(NAMES, one.movement.asked.largest.tolist(), strict=True)),
            "finer, true peaks": dict(zip(NAMES, seen.asked.largest.tolist(), strict=True)),
            "certified in the finer simulation": judgement.certificate is not None and judgement.certificate.converged,
        }
    told = chosen.record.results["design"]
    realised = 1.0 - rows[chosen.best.name]["finer"]["strap"] / rows[chosen.reference.name]["finer"]["strap"]
    interval = told["gain_interval"]
    table = calibrated.table("parameters")
    return {
        "parameters": {row["parameter"]: row[["value", "lower", "upper"]].to_dict() for _, row in table.iterrows()},
        "calibration certified": calibrated.accepted,
        "design accepted": chosen.accepted,
        "chosen": told["chosen"],
        "designs": rows,
        "front": chosen.table("front")[["limit of the knee [-]", "strap [N]", "share [-]", "timing [-]"]].to_dict(
            "records"
        ),
        "predicted gain": told["gain"],
        "predicted interval": interval,
        "gain in the finer simulation": realised,
        "inside": bool(interval[0] <= realised <= interval[1]),
        "residual of the finer simulation between its points, at most [N]": max(left),
        "cpu seconds": spent,
        "movements": told["movements"],
    }


def slopes(options: argparse.Namespace) -> dict[str, Any]:
    """On the shipped trial that was not used: every parameter of a movement, and the least force of the strap."""
    import numpy as np

    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
    from geocontact.dynamics.collocation.solve import SolverOptions
    from geocontact.standing_up.assistance_design import KNEE, HelpTask, designed
    from geocontact.standing_up.assistance_design import NAMES as PARAMETERS
    from geocontact.standing_up.assisted_model import ASSISTED_PARAMETERS, SHARE, assisted_model
    from geocontact.standing_up.assisted_movement import Movements
    from geocontact.standing_up.chain import EVERY_PLANTED
    from geocontact.standing_up.exoskeleton import STRAP_PLANTED

    given = standing_trials(SAMPLES / "standing_up_held_out" / "study.toml", "study")
    options_of = SolverOptions("radau", 4, 1, 1e-9)
    movements = Movements(assisted_model(given.subject), given.subject, given.trials, options_of, 20.0)
    p = np.r_[EVERY_PLANTED, STRAP_PLANTED, 0.3, 0.25]
    told, worst = movements.at(p).asked.slopes, {}
    for k, name in enumerate(PARAMETERS):
        step, sides = 1e-4 if abs(p[k]) < 0.5 else 1e-3, []
        for sign in (1.0, -1.0):
            beside = p.copy()
            beside[k] += sign * step
            sides.append(movements.at(beside, slopes=False).asked.sizes)
        again = (sides[0] - sides[1]) / (2.0 * step)
        worst[name] = float(np.abs(told[:, k] / again - 1.0).max())
    without = p.copy()
    without[SHARE] = 0.0
    knee = 0.8 * float(movements.at(without).asked.largest[KNEE])
    best = designed(movements, p[None], HelpTask(("share", "timing"), "strap", knee))
    optimum = {}
    ends = [designed(movements, best.p, HelpTask(best.task.vary, "strap", knee + by)).value for by in (0.2, -0.2)]
    optimum["limit of the knee"] = -best.price / ((ends[0] - ends[1]) / 0.4) - 1.0
    for k, name in enumerate(PARAMETERS):
        if k in best.task.index or name == "dissipation":
            continue
        step, ends = 1e-2 if ASSISTED_PARAMETERS[k].logarithm else 5e-4, []
        for sign in (1.0, -1.0):
            beside = best.p.copy()
            beside[:, k] += sign * step
            ends.append(designed(movements, beside, best.task).value)
        optimum[name] = best.slopes[k] / ((ends[0] - ends[1]) / (2.0 * step)) - 1.0
    return {
        "of a movement, largest relative difference by parameter": worst,
        "of the least force, relative difference": {name: float(value) for name, value in optimum.items()},
        "least force [N]": best.value,
    }


def robust(options: argparse.Namespace) -> dict[str, Any]:
    """On the shipped trial that was not used, with the intervals of part `gain`: chosen for one set and for all."""
    import pandas as pd

    import geocontact as gc

    warnings.simplefilter("ignore", gc.InputWarning)
    known = json.loads((options.out / "standing_design.json").read_text("utf-8"))["gain"]["parameters"]
    truth = pd.read_csv(SAMPLES / "standing_up_exoskeleton" / "truth.csv")[["parameter", "unit"]]
    told: dict[str, Any] = {"draws": options.draws}
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "parameters.csv"
        truth.join(pd.DataFrame(known).T, on="parameter").to_csv(file, index=False)
        for name, for_all in (("chosen", False), ("chosen for the draws", True)):
            began = time.process_time()
            study = SAMPLES / "standing_up_held_out" / "study.toml"
            found = gc.sit_to_stand.design(
                study, parameters=file, vary=VARY, nodes=12, draws=options.draws, robust=for_all, seed=SEED
            )
            draws, best = found.table("draws"), found.best
            limit = best.limit * float(found.designs[0].movement.asked.largest[NAMES.index("knee")])
            told[name] = {
                "accepted": found.accepted,
                "ending": best.design.ending if best.design is not None else "",
                "chosen": found.record.results["design"]["chosen"],
                "strap by the given parameters [N]": float(best.movement.asked.sizes[0]),
                "strap over the draws, at most [N]": float(draws["chosen [N]"].max()),
                "knee over the draws, at most, of its limit": float(draws["largest knee [N m]"].max() / limit),
                "gain over the draws, least": float(draws["gain [-]"].min()),
                "movements": found.record.results["design"]["movements"],
                "cpu seconds": time.process_time() - began,
            }
    return told


PARTS = {"slopes": slopes, "gain": gain, "robust": robust}


if __name__ == "__main__":
    main()
