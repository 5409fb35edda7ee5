"""The diagnosis of a strap whose missing effect is known: `python -m benchmarks.standing.gap OUT [--only EFFECT]`.

A person stands up seven times with an exoskeleton: twice to fit to, five times to judge by. The strap of the finer
simulation, five pads over 100 mm of the thigh, has one effect more than the calibrated one, or none; encoders of both
chains, torques, plates and a mat record it. The files that `sit-to-stand calibrate` writes become a case of the base
model `sit_to_stand` by `gap gather`, and it is diagnosed. Then what was planted, and what was named, is fitted once
inside the full model (`benchmarks.standing.refit`). Answers go to benchmarks/results/standing_gap.json. Everything is
synthetic and all numbers are invented.

What the base model cannot have is kept out, else all cases are one gap: help is large, so that the strap is loaded, and
encoders are better than the 0.3 degrees of the shipped trials. `left_out` tells what each of these is worth.
"""

from __future__ import annotations

import argparse
import json
import time as clock
import warnings
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import geocontact as gc
from benchmarks.machine import as_json, stamp
from benchmarks.standing.refit import NAMED, refitted
from benchmarks.standing.truth import PLANTED, PaddedStrap
from geocontact.analyses.sit_to_stand.exports import write_strap_case
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import STRAP_PARAMETERS, STRAP_PLANTED, StrapLaw, with_exoskeleton
from geocontact.standing_up.trials import StandingNoise, StandingTrial, recorded, standing_up, with_noise

ROOT = Path(__file__).resolve().parents[2]
SEED, RATE, INTERVALS = 34, 100.0, 30
ENCODERS = StandingNoise(angle=np.radians(0.01))
NONE = StandingNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
SECONDS = (1.5, 1.3, 1.7, 1.4, 1.6, 1.35, 1.55)
SEATED = np.radians(
    [
        [22.0, 70.0, 45.0],
        [18.0, 75.0, 50.0],
        [25.0, 68.0, 38.0],
        [20.0, 72.0, 47.0],
        [23.0, 69.0, 41.0],
        [19.0, 74.0, 49.0],
        [24.0, 71.0, 43.0],
    ]
)
HELP = (0.45, 0.6, 0.55, 0.5, 0.6, 0.45, 0.55)
"""Of each trial: seconds, leans at seat-off, and what the exoskeleton's torques are of the person's."""
HELD_OUT = 5
VALUES = {each.name: each.value(float(p)) for each, p in zip(STRAP_PARAMETERS, STRAP_PLANTED, strict=True)}
TRIALS = tuple(f"t0{k + 1}" for k in range(len(HELP)))
ONE_FORCE = ("preload", "sensor_offset", "motion_offset", "dead_zone", "contact_loss")
"""Names of one constant force, as long as the strap stays pressed."""
Made = tuple[StandingTrial, ...]


@dataclass(frozen=True)
class Planted:
    """What the finer strap has, what it is called in the full model, and which names or verdict would be right."""

    strap: PaddedStrap
    term: str = ""
    right: tuple[str, ...] = ()
    verdict: str = "no_gap"


PLANTED_EFFECTS = {
    "nothing": Planted(PaddedStrap()),
    "bushing preload": Planted(PaddedStrap(preload=20.0), "preload", ONE_FORCE, "explained"),
    "strap stiffening": Planted(PaddedStrap(stiffens=0.010), "stiffening", ("stiffening", "end_stop"), "explained"),
    "slip along the thigh": Planted(PaddedStrap(slips=8.0), "slip"),
    "mat that misses shear": Planted(PaddedStrap(tilt=np.radians(-25.0)), "tilt", (), "unknown"),
}
"""Slip along the thigh is nothing that a mat sees; no candidate mixes shear into it."""


def stood_up(strap: StrapLaw | None, k: int) -> StandingTrial:
    """One trial with a strap, as nobody's sensors see it. ArithmeticError where no motion is found."""
    subject = Subject()
    model = with_exoskeleton(subject, strap)
    _, found = standing_up(
        model,
        subject,
        seconds=SECONDS[k],
        seated=SEATED[k],
        planted=PLANTED,
        assistance=HELP[k],
        intervals=INTERVALS,
    )
    if not found.solved:
        raise ArithmeticError(f"{TRIALS[k]}: {found.ending}")
    return recorded(model, found.motions[0], PLANTED, RATE, NONE, 0, TRIALS[k])


def made_of(kept: Path, kind: str, noise: StandingNoise = ENCODERS) -> Made:
    """All trials of one case as they are recorded; those of an earlier run where their file is there."""
    seed, model = 100 * SEED + 10 * list(PLANTED_EFFECTS).index(kind), with_exoskeleton(Subject())
    return tuple(with_noise(_kept(kept, kind, k), model, noise, seed + k) for k in range(len(TRIALS)))


def _kept(kept: Path, kind: str, k: int) -> StandingTrial:
    file = kept / f"{kind.replace(' ', '_')}_{k}.npz"
    if not file.is_file():
        file.parent.mkdir(parents=True, exist_ok=True)
        made = vars(stood_up(PLANTED_EFFECTS[kind].strap, k))
        np.savez_compressed(file, **{name: each for name, each in made.items() if isinstance(each, np.ndarray)})
    with np.load(file) as found:
        return StandingTrial(**{**found, "name": TRIALS[k]})


def gathered(folder: Path, made: Made, held_out: int = HELD_OUT) -> Path:
    """A case by `gap gather`, of the files that `sit-to-stand calibrate` writes."""
    write_strap_case(folder / "gap", Subject(), made, VALUES, held_out)
    gc.gather(folder / "gap" / "gather.toml").write(folder / "case")
    return folder / "case"


def off_of(case: Path) -> float:
    """Root mean square of the base model at its first numbers less what the mat saw [N]."""
    read = gc.read_gap_case(case)
    system, values = gc.system_of(read), {each.name: each.start for each in read.parameters}
    trials = (*read.calibration, *read.evaluation)
    off = [system.simulate(t, values)[:, 0] - t.signals.column("thigh_force") for t in trials]
    return float(np.sqrt(np.mean(np.concatenate(off) ** 2)))


TURNS = {
    "five pads, no noise": 0.0,
    "encoders off by 0.01°": 0.01,
    "encoders off by 0.05°": 0.05,
    "angles off by 0.3°, as in the shipped trials": 0.3,
}
"""What angles are off by [deg]."""


def left_out(folder: Path) -> dict[str, dict[str, Any]]:
    """The base model beside the full one, nothing planted and a mat without noise; with its noise what is diagnosed."""
    told: dict[str, dict[str, Any]] = {}
    warnings.simplefilter("ignore")
    for kind, off in TURNS.items():
        angle, place = np.radians(off), folder / f"left_out_{off:g}"
        made = made_of(folder / "recordings", "nothing", replace(NONE, angle=angle))
        told[kind] = {"off_N": off_of(gathered(place / "exact", made))}
        if off:
            seen = made_of(folder / "recordings", "nothing", replace(ENCODERS, angle=angle))
            said = gc.diagnose(gathered(place / "seen", seen), bare=True).write(place / "diagnosis")
            found = json.loads((said / "diagnosis.json").read_text(encoding="utf-8"))
            told[kind] |= {"verdict": found["verdict"], "named": found["effects"]}
    return told


def answer(kind: str, folder: Path) -> dict[str, Any]:
    """One planted effect, from finer simulation to full model; that of an earlier run where its file is there."""
    warnings.simplefilter("ignore")
    planted, place = PLANTED_EFFECTS[kind], folder / kind.replace(" ", "_")
    kept = place / "answer.json"
    if kept.is_file():
        return dict(json.loads(kept.read_text(encoding="utf-8")))
    started = clock.process_time()
    made = made_of(folder / "recordings", kind)
    seconds = {"truth": clock.process_time() - started}
    case = gathered(place, made)
    started = clock.process_time()
    found = gc.diagnose(case)
    seconds["diagnosis"] = clock.process_time() - started
    out = found.write(place / "diagnosis")
    told = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
    named = told["effects"]
    started = clock.process_time()
    uses = made[:-HELD_OUT], made[-HELD_OUT:]
    terms = dict.fromkeys([planted.term, *(NAMED[each] for each in named if each in NAMED)])
    full = {term or "nothing": refitted(term, uses, ENCODERS) for term in terms}
    seconds["refit"] = clock.process_time() - started
    answered = {
        "right": list(planted.right),
        "verdict": told["verdict"],
        "named": named,
        "found": bool(set(named) & set(planted.right)) if planted.right else told["verdict"] == planted.verdict,
        "probabilities": dict(sorted(told["probabilities"].items(), key=lambda each: -each[1])[:3]),
        "absorbed": told["absorbed"],
        "where": told["where"],
        "gap": told["gap"],
        "ranking": pd.read_csv(out / "ranking.csv").iloc[:5].to_dict("records"),
        "full_model": full,
        "largest_force_N": float(max(np.abs(trial.strap).max() for trial in made if trial.strap is not None)),
        "seconds": seconds,
        "says": str(found),
    }
    kept.write_text(json.dumps(answered, default=str), encoding="utf-8")
    return answered


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.gap", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", choices=list(PLANTED_EFFECTS), action="append", help="all by default")
    asked = parser.parse_args()
    file = ROOT / "benchmarks" / "results" / "standing_gap.json"
    told: dict[str, Any] = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {"answers": {}}
    trials = {"fitted": len(HELP) - HELD_OUT, "held out": HELD_OUT}
    told |= {**stamp({"scipy", "casadi"}), "seed": SEED, "trials": trials}
    told["planted"] = {kind: asdict(planted.strap) for kind, planted in PLANTED_EFFECTS.items()}
    for kind in asked.only or PLANTED_EFFECTS:
        each = told["answers"][kind] = answer(kind, asked.out)
        shown = "; ".join(
            f"{term}: {one['before']['mat_N']:.2f} -> {one.get('after', one['before'])['mat_N']:.2f} N"
            for term, one in each["full_model"].items()
        )
        file.write_text(as_json(told), encoding="utf-8")
        print(f"{kind}: {each['verdict']} {', '.join(each['named'])}; full model, held out: {shown}", flush=True)
    told["left_out"] = left_out(asked.out)
    file.write_text(as_json(told), encoding="utf-8")


if __name__ == "__main__":
    main()
