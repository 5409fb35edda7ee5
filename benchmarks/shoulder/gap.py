"""The diagnosis of a shoulder exoskeleton whose missing effect is known: `python -m benchmarks.shoulder.gap OUT`.

Recordings with one effect each, or none, are the `held` ones of `benchmarks.shoulder.planted`; the package's 3-D model
is projected on its plane (`shoulder simulate` writes the files), `gap gather` makes the case, and the base model
`shoulder` is diagnosed. Answers go to benchmarks/results/shoulder_gap.json. What was named is fitted inside the full
3-D model by `benchmarks.shoulder.refit`. `left_out` tells how far the base model is from the full one as what it cannot
have is given up one by one.
"""

from __future__ import annotations

import argparse
import json
import time as clock
import warnings
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import geocontact as gc
from benchmarks.machine import as_json, machine, versions
from benchmarks.shoulder.planted import (
    CALIBRATION,
    EVALUATION,
    HELD,
    LOOSE,
    TRIALS,
    in_plane,
    motion_of,
    recorded,
    trial_of,
)
from benchmarks.shoulder.trials import dominant_arm, wearer_of
from benchmarks.shoulder.truth import LOGGER, Measured
from geocontact.analyses.shoulder.simulate.exports import write_plane
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, simulate_arm
from geocontact.shoulder_exoskeleton.synthetic import OverheadTrial
from geocontact.shoulder_exoskeleton.working_arm import SimulatedArm

ROOT = Path(__file__).resolve().parents[2]
RIGHT: dict[str, tuple[str, ...]] = {
    "nothing": (),
    "push force": ("event_load",),
    "poor contact": ("contact_loss", "dead_zone"),
    "force at zero elevation": ("preload", "sensor_offset"),
    "jump at lowering": ("dry_friction",),
}
"""The names that would be right, by what was planted."""
Made = dict[str, tuple[OverheadTrial, Measured, ArmSimulation]]
"""By trial: the trial, what logger and mat show, and the full model along the same motion."""


def made_of(kept: Path, kind: str) -> Made:
    """Every trial with this effect planted."""
    made = {}
    for name in TRIALS:
        trial = trial_of(name)
        level = float(trial.condition.level or 0.0)
        simulation = simulate_arm(motion_of(trial, "held"), HELD, wearer_of(trial.participant), level)
        made[name] = (trial, recorded(kept, kind, name, "held"), simulation)
    return made


def left_out(folder: Path) -> dict[str, dict[str, float]]:
    """Root mean square of the base model less the full one, nothing withheld and no noise, over the four trials."""
    kinds = {
        "as the study": (LOOSE, None),
        "passive joints locked, arms in the plane": (HELD, False),
        "and the shoulder stays": (HELD, True),
        "and no friction in the cuff": (HELD.having(mu_s=0.0, mu_k=0.0), True),
    }
    told = {}
    for kind, (device, still) in kinds.items():
        made = {}
        for name in TRIALS:
            trial = trial_of(name)
            wearer, motion = wearer_of(trial.participant), dominant_arm(trial)
            motion = motion if still is None else in_plane(motion, device, wearer, still)
            s = simulate_arm(motion, device, wearer, float(trial.condition.level or 0.0))
            cells = np.zeros((len(motion.time), 0, 0))
            made[name] = (trial, Measured(motion.time, s.angles, s.elevation, cells, s.supporting, s.supporting), s)
        case = gc.read_gap_case(gathered(folder / kind.replace(" ", "_"), made))
        system, values = gc.system_of(case), {each.name: each.start for each in case.parameters}
        trials = (*case.calibration, *case.evaluation)
        shown = [np.column_stack([t.signals.column(name) for name in ("exo", "force")]) for t in trials]
        off = np.concatenate([system.simulate(t, values) - seen for t, seen in zip(trials, shown, strict=True)])
        exo, force = np.sqrt(np.mean(off**2, axis=0))
        told[kind] = {"exo_deg": float(np.degrees(exo)), "force_N": float(force)}
    return told


def gathered(folder: Path, made: Made) -> Path:
    """A case by `gap gather`, of the files that `shoulder simulate` writes and of what was recorded."""
    for name, (trial, found, simulation) in made.items():
        write_plane(folder / name, SimulatedArm(simulation, trial.phase))
        shown = {"time [s]": found.time, "exo [deg]": np.degrees(found.logger), "force [N]": found.mat}
        pd.DataFrame(shown).round(4).to_csv(folder / name / "recorded.csv", index=False)
    side = made["t01"][2].motion.side
    template = (folder / "t01" / f"{side}.toml").read_text(encoding="utf-8")
    constants = template[template.index("[constants]") :]
    text = f'format = 1\nsystem = "shoulder"\nsupport = "t01/support.csv"\ncalibration = {json.dumps(CALIBRATION)}\n'
    text += f"evaluation = {json.dumps(EVALUATION)}\n"
    for name, (trial, _, _) in made.items():
        text += f'\n[from.{name}]\ninputs = "{name}/{side}.csv"\noutputs = "{name}/recorded.csv"\n'
        text += f"\n[trial.{name}]\nlevel = {trial.condition.level:g}\n"
    (folder / "gather.toml").write_text(text + "\n" + constants, encoding="utf-8")
    gc.gather(folder / "gather.toml").write(folder / "case")
    return folder / "case"


def answer(kind: str, folder: Path) -> tuple[str, dict[str, Any]]:
    """One planted effect, from the finer code to the full model; that of an earlier run where its file is there."""
    warnings.simplefilter("ignore")
    right = RIGHT[kind]
    place = folder / kind.replace(" ", "_")
    kept = place / "answer.json"
    if kept.is_file():
        return kind, json.loads(kept.read_text(encoding="utf-8"))
    started = clock.process_time()
    made = made_of(folder / "recordings", kind)
    truth_seconds = clock.process_time() - started
    case = gathered(place, made)
    started = clock.process_time()
    found = gc.diagnose(case)
    seconds = clock.process_time() - started
    out = found.write(place / "diagnosis")
    told = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
    named = [each["effect"] if isinstance(each, dict) else str(each) for each in told.get("effects", [])]
    ranking = pd.read_csv(out / "ranking.csv")
    answered = {
        "right": list(right),
        "verdict": told["verdict"],
        "named": named,
        "found": bool(set(named) & set(right)) if right else told["verdict"] == "no_gap",
        "ranking": ranking.iloc[:5].to_dict("records"),
        "where": told.get("where"),
        "reduction": {channel: [each["reduction"], *each["ci95"]] for channel, each in told["gap"].items()},
        "seconds": seconds,
        "truth_seconds": truth_seconds,
        "says": str(found),
    }
    kept.write_text(json.dumps(answered, default=str), encoding="utf-8")
    return kind, answered


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", choices=list(RIGHT))
    asked = parser.parse_args()
    kinds = [asked.only] if asked.only else list(RIGHT)
    with ProcessPoolExecutor(2) as pool:
        found = dict(pool.map(partial(answer, folder=asked.out), kinds))
    for kind, each in found.items():
        print(f"{kind}: {each['verdict']} {', '.join(each['named'])} ({each['seconds']:.0f} s)")
    if not asked.only:
        file = ROOT / "benchmarks" / "results" / "shoulder_gap.json"
        told = {"machine": machine(), "versions": versions({"scipy", "casadi"}), "logger_step_deg": LOGGER[0]}
        told |= {"left_out": left_out(asked.out / "left_out"), "answers": found}
        file.write_text(as_json(told), encoding="utf-8")


if __name__ == "__main__":
    main()
