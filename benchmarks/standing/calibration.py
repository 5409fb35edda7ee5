"""Contacts calibrated on synthetic trials of standing up: `python -m benchmarks.standing.calibration [PART …]
[--noises 20]`.

Parts: coverage (how often intervals of 95 % hold what was planted, over noises, as found and with the bias of resampled
trials taken off), nodes (the same estimates on 50, 100 and 200 nodes a second, with their times), starts (success from
20 random starts), exoskeleton (phases A and B of three trials, and a held-out trial by every predictor), profiles (of
the feet's parameters), strap profiles. Everything is synthetic; truth and calibration share their equations.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
SAMPLES = HERE.parent / "meshes"
NODES = (50.0, 100.0, 200.0)


def main() -> None:
    """Measure, print, write the JSON; parts that were not asked for stay as they were."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.standing.calibration", description=__doc__.splitlines()[0]
    )
    parser.add_argument("parts", nargs="*", default=list(PARTS), metavar="PART")
    parser.add_argument("--noises", type=int, default=20)
    parser.add_argument("--resamples", type=int, default=6)
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import as_json, stamp

    options.out.mkdir(parents=True, exist_ok=True)
    file = options.out / "standing_up.json"
    report: dict[str, Any] = json.loads(file.read_text("utf-8")) if file.is_file() else {}
    for part in options.parts:
        began = time.process_time()
        report[part] = PARTS[part](options) | stamp({"casadi", "numpy", "scipy"})
        report[part]["cpu seconds of it all"] = time.process_time() - began
        file.write_text(as_json(report, 2), encoding="utf-8")
        print(json.dumps({part: report[part]}, indent=2), flush=True)


def calibrated(study: Any, nodes_a_second: float = 30.0, resamples: int = 0, start: Any = None) -> Any:
    """Phase A of all trials of a study."""
    from geocontact.dynamics.collocation.solve import SolverOptions
    from geocontact.standing_up.calibrated_phase import PhaseSearch, calibrated_phase
    from geocontact.standing_up.chain import SOUGHT
    from geocontact.standing_up.phases import phase_a

    def build(trials: Any, begin: Any) -> Any:
        at = start if begin is None else begin
        return phase_a(study.model, study.subject, trials, study.noise, free=SOUGHT, start=at)

    search = PhaseSearch(SolverOptions("radau", 4, 1, 1e-7, 300), nodes_a_second, resamples=resamples, seed=1)
    return calibrated_phase("A", study.model, study.trials, study.noise, build, search)


def off_in_sd(one: Any, planted: Any) -> Any:
    """Deviations of the parameters that were sought from what was planted, over their standard deviations."""
    import numpy as np

    numbers = [(n, each, at) for n, each, at in zip(one.numbers.numbers, one.phase.parameters, planted, strict=True)]
    sought = [each for each in numbers if each[0].verdict != "held"]
    return np.array([(each.searched(n.value) - at) / n.after for n, each, at in sought])


def coverage(options: argparse.Namespace) -> dict[str, Any]:
    """Over noises, with and without resampled trials; certificates of all motions."""
    import numpy as np

    from geocontact.standing_up.chain import SOUGHT
    from meshes.standing_study import synthetic_study

    found: dict[str, Any] = {"noises": options.noises, "resamples": options.resamples}
    studies = [synthetic_study(seed=noise + 1) for noise in range(options.noises)]
    for label, resamples in (("as found", 0), ("bias taken off", options.resamples)):
        parts, seconds, passed = [], [], []
        for study in studies:
            began = time.process_time()
            one = calibrated(study, resamples=resamples)
            seconds.append(time.process_time() - began)
            parts.append(off_in_sd(one, study.planted))
            passed.append([each.certificate is not None and each.certificate.converged for each in one.motions])
            print(label, np.round(parts[-1], 2), f"{seconds[-1]:.1f} s", passed[-1], flush=True)
        off = np.array(parts)
        found[label] = {
            "held by the 95 % interval": dict(zip(SOUGHT, (np.abs(off) <= 1.96).sum(axis=0).tolist(), strict=True)),
            "mean in standard deviations": dict(zip(SOUGHT, off.mean(axis=0).tolist(), strict=True)),
            "spread in standard deviations": dict(zip(SOUGHT, off.std(axis=0).tolist(), strict=True)),
            "cpu seconds, median": float(np.median(seconds)),
            "motions certified": f"{int(np.sum(passed))} of {np.size(passed)}",
        }
    return found


def nodes(options: argparse.Namespace) -> dict[str, Any]:
    """The shipped study on three meshes."""
    from meshes.standing_study import synthetic_study

    study, rows = synthetic_study(), {}
    for count in NODES:
        one = calibrated(study, count)
        rows[f"{count:g} a second"] = {
            "ending": one.found.ending,
            "cpu seconds": one.found.seconds,
            "iterations": one.found.iterations,
            "parameters": {n.name: [n.value, n.lower, n.upper] for n in one.numbers.numbers},
            "residual [N]": max(float(each.force.max()) for each in one.motions),
            "residual [N m]": max(float(each.moment.max()) for each in one.motions),
            "certified": one.certified,
        }
        print(json.dumps(rows, indent=2), flush=True)
    return rows


def starts(options: argparse.Namespace) -> dict[str, Any]:
    """Starts drawn from what is believed, of the shipped study."""
    import numpy as np

    from geocontact.standing_up.chain import FOOT_PARAMETERS
    from geocontact.standing_up.strap_sites import usual
    from meshes.standing_study import synthetic_study

    study, rng = synthetic_study(), np.random.default_rng(20)
    sd = np.array([each.sd for each in FOOT_PARAMETERS])
    ends = []
    for _ in range(options.starts):
        one = calibrated(study, start=usual(FOOT_PARAMETERS) + sd * rng.normal(size=len(sd)))
        ends.append((one.found.solved, one.found.objective, one.found.seconds))
        print(ends[-1], flush=True)
    best = min(objective for solved, objective, _ in ends if solved)
    return {
        "starts": len(ends),
        "solved": sum(solved for solved, _, _ in ends),
        "in the best minimum": sum(solved and objective < best * 1.001 for solved, objective, _ in ends),
        "objectives": sorted(round(objective, 4) for solved, objective, _ in ends if solved),
        "cpu seconds, median": float(np.median([seconds for _, _, seconds in ends])),
    }


def exoskeleton(options: argparse.Namespace) -> dict[str, Any]:
    """The shipped trials through both commands: parameters beside the planted ones, errors by predictor."""
    import csv
    import tempfile

    import geocontact as gc

    folder = SAMPLES / "standing_up_exoskeleton"
    found = gc.sit_to_stand.calibrate(folder / "study.toml", nodes=45.0, resamples=options.resamples)
    with (folder / "truth.csv").open(encoding="utf-8") as file:
        planted = {row["parameter"]: float(row["value"]) for row in csv.DictReader(file)}
    table = found.table("parameters")
    with tempfile.TemporaryDirectory() as out:
        found.write(out)
        held_out = SAMPLES / "standing_up_held_out" / "study.toml"
        parameters = Path(out) / "parameters.csv"
        predicted = gc.sit_to_stand.predict(held_out, parameters=parameters, against=folder / "study.toml")
    return {
        "resamples": options.resamples,
        "parameters": {
            row["parameter"]: {"planted": planted[row["parameter"]], **row[["value", "lower", "upper"]].to_dict()}
            for _, row in table.iterrows()
        },
        "phases": {name: told for name, told in found.record.results.items() if name.startswith("phase")},
        "certificate": found.table("certificate").to_dict("records"),
        "predicted": predicted.record.results["predict"],
    }


def profiles(options: argparse.Namespace) -> dict[str, Any]:
    """Rise of minus twice the log posterior three standard deviations off, on the shipped study; Laplace's is 9."""
    import geocontact as gc

    found = gc.sit_to_stand.calibrate(SAMPLES / "standing_up" / "study.toml", resamples=0, profiles=1)
    table = found.table("profiles")
    off = table[table["distance in sd [-]"] != 0.0]
    return {
        "rise three sd below and above": {
            name: own["rise [-]"].round(2).tolist() for name, own in off.groupby("parameter", sort=False)
        }
    }


def strap_profiles(options: argparse.Namespace) -> dict[str, Any]:
    """The same of the strap in phase B, feet held at what was planted, on the shipped study with an exoskeleton."""
    import numpy as np

    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
    from geocontact.dynamics.collocation.solve import SolverOptions
    from geocontact.standing_up.calibrated_phase import PhaseSearch, calibrated_phase
    from geocontact.standing_up.chain import EVERY_PLANTED
    from geocontact.standing_up.exoskeleton import strapped
    from geocontact.standing_up.phases import phase_b

    study = standing_trials(SAMPLES / "standing_up_exoskeleton" / "study.toml", "study")
    model = strapped(study.subject, study.sites)

    def build(trials: Any, begin: Any) -> Any:
        return phase_b(model, study.subject, trials, study.noise, EVERY_PLANTED)

    search = PhaseSearch(SolverOptions("radau", 4, 1, 1e-7, 300), 30.0, profiles=1)
    exact = np.zeros((len(model.parameters), len(model.parameters)))
    one = calibrated_phase("B", model, study.trials, study.noise, build, search, held=exact)
    rises = {each.name: [round(float(r), 2) for r in each.rise[each.distance != 0.0]] for each in one.profiles}
    jerk = {n.name: n.assumed / n.after for n in one.numbers.numbers if n.verdict in ("known", "prior-dominated")}
    return {"rise three sd below and above": rises, "sd of the jerk's size, of the whole sd": jerk}


def freed(options: argparse.Namespace) -> dict[str, Any]:
    """A with and without radius and dissipation, B with one, two and four numbers of the strap.

    What is not sought is held at what is believed, the feet in B at what was planted: there intervals have the share of
    the jerk's size, and what is off is said by the trials alone, too.
    """
    import numpy as np

    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
    from geocontact.standing_up.chain import EVERY_PLANTED, SOUGHT, SOUGHT_WORN
    from geocontact.standing_up.exoskeleton import STRAP, STRAP_PLANTED, strapped
    from geocontact.standing_up.phases import phase_a, phase_b
    from meshes.standing_study import synthetic_study

    rows, alone = {}, synthetic_study()
    sets_a = {"A without radius": tuple(name for name in SOUGHT if name != "radius"), "A": SOUGHT}
    for label, free in (sets_a | {"A with dissipation": SOUGHT_WORN}).items():
        phase = phase_a(alone.model, alone.subject, alone.trials, alone.noise, free=free)
        rows[label] = told_of(phase, alone.trials, alone.planted)
    study = standing_trials(SAMPLES / "standing_up_exoskeleton" / "study.toml", "study")
    model, planted = strapped(study.subject, study.sites), [*EVERY_PLANTED, *STRAP_PLANTED]
    for label, free in (("B, normal", STRAP[:1]), ("B, normal and tangential", STRAP[:2]), ("B", STRAP)):
        phase = phase_b(model, study.subject, study.trials, study.noise, EVERY_PLANTED, free=free)
        rows[label] = told_of(phase, study.trials, planted, np.zeros((len(planted), len(planted))))
    return rows


def told_of(phase: Any, trials: Any, planted: Any, held: Any = None) -> dict[str, Any]:
    """A phase solved: deviation from what was planted, what is left of the belief, how sharply all are told.

    `held` is the covariance of what the phase holds; None leaves the shares of what is assumed out.
    """
    import numpy as np

    from geocontact.dynamics.collocation.solve import SolverOptions, solve
    from geocontact.standing_up.contact_numbers import contact_numbers

    meshes = tuple(np.linspace(0.0, 1.0, round(30.0 * float(t.time[-1])) + 1) for t in trials)
    found = solve(phase.control, SolverOptions("radau", 4, 1, 1e-7, 300), meshes=meshes)
    numbers = contact_numbers(phase, found, held=held)
    off = np.abs(numbers.correlation - np.eye(len(numbers.names)))
    told = {
        "ending": found.ending,
        "objective": found.objective,
        "cpu seconds": found.seconds,
        "sharper than believed": numbers.directions.tolist(),
        "largest correlation": float(off.max(initial=0.0)),
        "parameters": {
            n.name: {
                "value": n.value,
                "planted": each.value(float(at)),
                "off in sd": (each.searched(n.value) - float(at)) / n.after,
                "off in sd by the trials": (each.searched(n.value) - float(at)) / n.by_trials,
                "sd left of the belief": n.after / n.before,
            }
            for n, each, at in zip(numbers.numbers, phase.parameters, planted, strict=True)
            if n.verdict in ("known", "prior-dominated")
        },
    }
    print(json.dumps(told), flush=True)
    return told


PARTS = {"coverage": coverage, "nodes": nodes, "starts": starts, "exoskeleton": exoskeleton, "profiles": profiles,
         "strap profiles": strap_profiles, "freed": freed}  # fmt: skip


if __name__ == "__main__":
    main()
