"""The diagnosis of a shoulder exoskeleton whose missing effect is known: `python -m benchmarks.shoulder_gap OUT`.

Finer 3-D code makes logger and mat of four trials of one synthetic participant with one effect, or none; the package's
3-D model is projected on its plane (`shoulder simulate` writes the files), `gap gather` makes the case, and the base
model `shoulder` is diagnosed. Then what was named is added to the full 3-D model, fitted to the calibration trials and
judged on the held-out ones. Answers go to benchmarks/results/shoulder_gap.json.

What the base model cannot have is kept out of the truth, else all cases are one gap: the passive joints are locked, the
arms are raised in the plane of the active joint about a shoulder that stays, gravity lies in it. Cells lie on one ring,
so that the cuff does not clamp, and the cuff is long enough that no arm leaves it; friction is a tenth of the paper's.
The logger has its steps but no lag, which is an effect of its own. `left_out` tells how far the base model is from the
full one as these are given up one by one.
"""

from __future__ import annotations

import argparse
import json
import time as clock
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import lsq_linear

import geocontact as gc
from benchmarks.machine import machine, versions
from benchmarks.shoulder_trials import dominant_arm, wearer_of
from benchmarks.shoulder_truth import LOGGER, Measured, Truth, Withheld, measure
from geocontact.analyses.shoulder.simulate.plane_files import write_plane
from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.lucy import lucy
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, simulate_arm
from geocontact.shoulder_exoskeleton.support.phases import SCREW
from geocontact.shoulder_exoskeleton.synthetic.design import condition, participant, task
from geocontact.shoulder_exoskeleton.synthetic.trial import OverheadTrial, synthetic_trial

ROOT = Path(__file__).resolve().parents[1]
PERSON = "P1"
TRIALS = {"t01": ("T1", "S50"), "t02": ("T2", "S100"), "t03": ("T1", "S100"), "t04": ("T2", "S50")}
CALIBRATION, EVALUATION = ("t01", "t02"), ("t03", "t04")
PLANTED: dict[str, tuple[Withheld, tuple[str, ...]]] = {
    "nothing": (Withheld(), ()),
    "push force": (Withheld(push=0.3), ("event_load",)),
    "poor contact": (Withheld(gap=6e-3), ("contact_loss", "dead_zone")),
    "force at zero elevation": (Withheld(strap=1.5e-2), ("preload", "sensor_offset")),
    "jump at lowering": (Withheld(seal=0.8), ("dry_friction",)),
}
"""What the finer code withholds, and the names that would be right."""
FREE = lucy().having(cuff_length=0.25, mu_s=0.1, mu_k=0.08, passive_1_damping=0.5, passive_2_damping=0.5)
LOCKED = {f"passive_{k}_{end}": sign * np.radians(0.05) for k in (1, 2) for end, sign in (("lower", -1), ("upper", 1))}
DEVICE = FREE.having(**LOCKED, stop_stiffness=1e4, stop_width=1e-3)
"""Its passive joints are held within 0.07 degrees."""
DOWN = np.array([0.0, 0.0, -9.81])
SLOW = 0.05
"""rad/s; the direction of a movement is u over its size above this."""
STEP = np.radians(LOGGER[0])


def in_plane(motion: ArmMotion, device: Device, wearer: Wearer, still: bool = True) -> ArmMotion:
    """The same elevation in the plane through the cuff's middle, as if the arm were turned forwards.

    `still` holds the shoulder at its mean place.
    """
    p, of = adjusted_numbers(device, wearer, 1.0), slices()
    upper = motion.interface - motion.shoulder
    ahead = np.linalg.norm(upper[:, :2], axis=1)
    shoulder = motion.shoulder.copy()
    shoulder[:, 0] = sum(p[of[part]][0] for part in ("base", "link_1", "link_2", "cuff"))
    if still:
        shoulder[:, 1:] = shoulder[:, 1:].mean(axis=0)
    flat = np.column_stack([0.0 * ahead, -ahead, upper[:, 2]])
    elevation = np.arctan2(ahead, -upper[:, 2])
    return replace(motion, shoulder=shoulder, interface=shoulder + flat, elevation=elevation, gravity=DOWN)


def recorded(name: str, withheld: Withheld) -> tuple[OverheadTrial, Measured, ArmSimulation]:
    """A trial, what logger and mat show, and the full model along the same motion."""
    work, worn = TRIALS[name]
    trial = synthetic_trial(participant(PERSON), task(work), condition(worn))
    level, wearer = float(trial.condition.level or 0.0), wearer_of(trial.participant)
    motion = in_plane(dominant_arm(trial), DEVICE, wearer)
    truth = Truth(DEVICE, wearer, level, withheld)
    truth.s = 0.0 * truth.s
    pushing = np.where(trial.phase == SCREW, trial.task.push, 0.0)
    seed = 10 * list(TRIALS).index(name) + [w for w, _ in PLANTED.values()].index(withheld)
    found = measure(truth, motion, seed, pushing)
    prompt = replace(found, logger=np.round(found.angles[:, 2] / STEP) * STEP)
    return trial, prompt, simulate_arm(motion, DEVICE, wearer, level)


def left_out(folder: Path) -> dict[str, dict[str, float]]:
    """Root mean square of the base model less the full one, nothing withheld and no noise, over the four trials."""
    kinds = {
        "as the study": (FREE, None),
        "passive joints locked, arms in the plane": (DEVICE, False),
        "and the shoulder stays": (DEVICE, True),
        "and no friction in the cuff": (DEVICE.having(mu_s=0.0, mu_k=0.0), True),
    }
    told = {}
    for kind, (device, still) in kinds.items():
        made = {}
        for name, (work, worn) in TRIALS.items():
            trial = synthetic_trial(participant(PERSON), task(work), condition(worn))
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


def gathered(folder: Path, made: dict[str, tuple[OverheadTrial, Measured, ArmSimulation]]) -> Path:
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


def regressor(effect: str, trial: OverheadTrial, s: ArmSimulation) -> np.ndarray | None:
    """What one unit of a named effect adds to the full model's force; None where it has no such term."""
    if effect == "event_load":
        return (trial.phase == SCREW).astype(float)
    if effect in ("preload", "sensor_offset"):
        return np.ones(len(s.motion.time))
    if effect == "dry_friction":
        reach = s.device["armrest_share"] * s.wearer.upper_arm
        return -np.tanh(s.rates[:, 2] / SLOW) / reach
    if effect == "sensor_gain":
        return s.supporting
    return None


def refitted(effects: list[str], made: dict[str, tuple[OverheadTrial, Measured, ArmSimulation]]) -> dict[str, Any]:
    """Held-out error of the full model without and with what was named [N], fitted to the calibration trials."""

    def rows(names: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray]:
        residual, columns = [], []
        for name in names:
            trial, found, s = made[name]
            residual.append(found.mat - s.supporting)
            terms = [regressor(effect, trial, s) for effect in effects]
            columns.append(np.column_stack([term for term in terms if term is not None] or [0.0 * s.supporting]))
        return np.concatenate(residual), np.concatenate(columns)

    y, x = rows(CALIBRATION)
    size = lsq_linear(x, y).x
    held, columns = rows(EVALUATION)
    before, after = (float(np.sqrt(np.mean(e**2))) for e in (held, held - columns @ size))
    return {"before_N": before, "after_N": after, "size": [float(each) for each in size]}


def answer(kind: str, folder: Path) -> tuple[str, dict[str, Any]]:
    """One planted effect, from the finer code to the full model; that of an earlier run where its file is there."""
    warnings.simplefilter("ignore")
    withheld, right = PLANTED[kind]
    place = folder / kind.replace(" ", "_")
    kept = place / "answer.json"
    if kept.is_file():
        return kind, json.loads(kept.read_text(encoding="utf-8"))
    started = clock.process_time()
    made = {name: recorded(name, withheld) for name in TRIALS}
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
        "full_model": refitted(named or list(right), made),
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
    parser.add_argument("--only", choices=list(PLANTED))
    asked = parser.parse_args()
    kinds = [asked.only] if asked.only else list(PLANTED)
    with ProcessPoolExecutor(2) as pool:
        found = dict(pool.map(partial(answer, folder=asked.out), kinds))
    for kind, each in found.items():
        full = each["full_model"]
        print(
            f"{kind}: {each['verdict']} {', '.join(each['named'])} ({each['seconds']:.0f} s); full model, held out: "
            f"{full['before_N']:.2f} -> {full['after_N']:.2f} N"
        )
    if not asked.only:
        file = ROOT / "benchmarks" / "results" / "shoulder_gap.json"
        told = {"machine": machine(), "versions": versions({"scipy", "casadi"}), "logger_step_deg": LOGGER[0]}
        told |= {"left_out": left_out(asked.out / "left_out"), "answers": found}
        file.write_text(json.dumps(told, indent=1, default=str) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
