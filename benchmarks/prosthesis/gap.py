"""The diagnosis of a prosthetic foot whose missing effect is known: `python -m benchmarks.prosthesis.gap OUT`.

A foot is driven along four synthetic stances of one participant. Finer code, a continuous keel on dense foam, makes
what markers and plate show, with one effect withheld or none; `gap gather` makes a case of the base model `foot` from
files as `prosthesis simulate` writes them; it is diagnosed. Then what was withheld is added to the package's keel of 8
hinges and 24 spheres, fitted to the calibration trials beside the numbers of the sole, and judged on the held-out ones.
Answers go to benchmarks/results/prosthesis_gap.json; a case run by itself (`--only`) takes the place of its own.

What the base model cannot have is kept out of the truth, else all cases are one gap: there is no friction along the
floor, the foot moves in its plane, and it pitches less. `left_out` tells how far the base model is from stances as they
are walked.
"""

from __future__ import annotations

import argparse
import json
import time as clock
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.interpolate import make_interp_spline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

import geocontact as gc
from benchmarks.machine import as_json, commit, machine, versions
from benchmarks.prosthesis.keel_stance import heights
from benchmarks.prosthesis.refit import (
    LACKING,
    SETTING,
    Trials,
    centre_seen,
    foot_without,
    fulcrum,
    predicted,
    refitted,
)
from benchmarks.prosthesis.truth import EVERY, GATE, FootPath, Measured, Truth, Withheld, measure
from geocontact.analyses.prosthesis.stance_files import pose_table, reaction_table, write_sole
from geocontact.below_knee_prosthesis.evaluation import longest_stance
from geocontact.below_knee_prosthesis.foot_in_plane import FootInPlane, in_plane, row_numbers
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from meshes.gait_persons import PARTICIPANTS
from meshes.gait_trial import synthetic_trial

ROOT = Path(__file__).resolve().parents[2]
PERSON = PARTICIPANTS[0]
TRIALS = ("t01", "t02", "t03", "t04")
CALIBRATION, EVALUATION = TRIALS[:2], TRIALS[2:]
AROUND = 0.05
"""s; before and after a stance that belong to its trial."""
SHARE, LIFTED = 0.4, 0.2
"""Of the pitch after mid-stance, as with more the keel bends too much for a rigid foot; m/s, beside the stance."""
STEP, SMOOTH = 2e-3, 0.012
"""s; of the synthetic stances, and standard deviation of what load, pitch and height are smoothed with."""


@dataclass(frozen=True)
class Planted:
    """What the finer code withholds, what the models lack, and which names would be right.

    Parameters
    ----------
    field
        Of the package's foot that the effect is: what is fitted in it.
    right
        Names of the base model's candidates; none where it has none.
    held
        Whether stiffness (base model) and all numbers of the sole are those found while nothing was missing.
    """

    withheld: Withheld
    field: str = ""
    right: tuple[str, ...] = ()
    held: bool = False


PLANTED = {
    "nothing": Planted(Withheld()),
    "keel hysteresis": Planted(Withheld(hysteresis=0.15), "hysteresis", ("asymmetry", "damping", "relaxation")),
    "pistoning": Planted(Withheld(pistoning=True), "socket", ("series_compliance", "relaxation")),
    "missing heel spheres": Planted(Withheld(), "heel"),
    "wrong fulcrum": Planted(Withheld(fulcrum=0.02), "fulcrum"),
    "fulcrum slipped since": Planted(Withheld(fulcrum=0.02), "fulcrum", ("series_compliance",), held=True),
}


def driven() -> dict[str, FootPath]:
    """How a machine moves the foot in its plane: load and pitch of four synthetic stances.

    After mid-stance it pitches less; before and after the stance it is lifted.
    """
    foot, paths = vsf_foot(joints=24, finer=4), {}
    none = np.zeros(len(foot.sole.spheres))
    still = replace(foot, law=replace(foot.law, static=none, kinetic=none)).at(fulcrum())
    for k, name in enumerate(TRIALS):
        truth = synthetic_trial(PERSON, SETTING, k + 1).truth
        span = longest_stance(truth.time, truth.force[:, 1])
        assert span is not None
        kept = (truth.time >= span[0] - 2.0 * AROUND) & (truth.time <= span[1] + 2.0 * AROUND)
        walked = in_plane(truth.time[kept], truth.poses[kept])
        few = slice(None, None, 4)
        time = walked.time[few]
        load = gaussian_filter1d(truth.force[kept, 1], SMOOTH / STEP)[few]
        pitch = gaussian_filter1d(np.where(walked.pitch < 0.0, SHARE * walked.pitch, walked.pitch), SMOOTH / STEP)
        height = heights(still, Rotation.from_euler("z", pitch[few][:, None]), load)
        outside = np.maximum(np.maximum(span[0] - time, time - span[1]), 0.0)
        height = gaussian_filter1d(height + LIFTED * outside, SMOOTH / (4.0 * STEP))
        dense = make_interp_spline(time, height, k=5)
        inside = (walked.time >= span[0] - AROUND) & (walked.time <= span[1] + AROUND) & (walked.time <= time[-1])
        pose = np.column_stack([walked.x, dense(np.minimum(walked.time, time[-1])), pitch])
        paths[name] = FootPath(walked.time[inside], pose[inside])
    return paths


def recorded(kind: str, paths: dict[str, FootPath]) -> Trials:
    """All trials of one case."""
    truth = Truth(vsf_foot(joints=24, finer=4), fulcrum(), PLANTED[kind].withheld)
    return {name: measure(truth, path, seed) for (name, path), seed in zip(paths.items(), seeds()[kind], strict=True)}


def seen_foot(path: FootPath) -> FootInPlane:
    """As files of it are written."""
    return FootInPlane(path.time, *path.pose.T, np.array([1.0, 0.0, 0.0]))


def gathered(
    folder: Path,
    made: Trials,
    lacking: tuple[str, ...] = (),
    held: Trials | None = None,
    uses: tuple[tuple[str, ...], tuple[str, ...]] = (CALIBRATION, EVALUATION),
) -> Path:
    """A case by `gap gather`, of files as `prosthesis simulate` writes them; `held` tells the stiffness."""
    for name, m in made.items():
        place = folder / name
        place.mkdir(parents=True, exist_ok=True)
        foot = seen_foot(m.path)
        pose_table(foot).to_csv(place / "foot.csv", index=False, float_format="%.9g")
        table = reaction_table(foot, m.plate[:, 0], m.plate[:, 1], centre_seen(m))
        table.round(6).to_csv(place / "plate.csv", index=False)
    own, first = foot_without(lacking), made["t01"]
    up, centre = predicted(own, first.path, fulcrum())
    told = row_numbers(seen_foot(first.path), own.sole.spheres, own.law, up, centre)
    if held is not None:
        m = together([held[name] for name in uses[0]])
        told = row_numbers(seen_foot(m.path), own.sole.spheres, own.law, m.plate[:, 1], centre_seen(m))
    write_sole(folder / "t01", own.sole.spheres, own.law, told)
    return case_of(folder, *uses, fixed=held is not None)


def case_of(folder: Path, calibration: tuple[str, ...], evaluation: tuple[str, ...], *, fixed: bool = False) -> Path:
    """Gathered from t01/foot.toml and the tables of each trial; `fixed`: no stiffness is free."""
    template = (folder / "t01" / "foot.toml").read_text(encoding="utf-8")
    numbers = template[template.index("[constants]") :]
    if fixed:
        stiffness, damping = numbers.split("[parameters.b_", maxsplit=1)
        numbers = stiffness.replace("lower = 0.0", "lower = 0.0\nfixed = true") + "[parameters.b_" + damping
    text = 'format = 1\nsystem = "foot"\nspheres = "t01/spheres.csv"\n'
    text += f"calibration = {json.dumps(calibration)}\nevaluation = {json.dumps(evaluation)}\n"
    for name in (*calibration, *evaluation):
        text += f'\n[from.{name}]\ninputs = "{name}/foot.csv"\noutputs = "{name}/plate.csv"\n'
    (folder / "gather.toml").write_text(text + "\n" + numbers, encoding="utf-8")
    gc.gather(folder / "gather.toml").write(folder / "case")
    return folder / "case"


def together(trials: list[Measured]) -> Measured:
    """One after the other, a second apart."""
    late = np.cumsum([0.0, *(np.ptp(m.path.time) + 1.0 for m in trials[:-1])])
    time = np.concatenate([m.path.time - m.path.time[0] + each for m, each in zip(trials, late, strict=True)])
    path = FootPath(time, np.concatenate([m.path.pose for m in trials]))
    return Measured(path, *(np.concatenate([getattr(m, key) for m in trials]) for key in ("load", "centre", "plate")))


def off_of(case: Path) -> dict[str, float]:
    """Root mean square of the base model at its first numbers less what was measured, over all trials of a case."""
    read = gc.read_gap_case(case)
    system, values = gc.system_of(read), {each.name: each.start for each in read.parameters}
    off = []
    for trial in (*read.calibration, *read.evaluation):
        shown = np.column_stack([trial.signals.column(name) for name in ("force_x", "force_y", "cop_x")])
        off.append(system.simulate(trial, values) - shown)
    forward, up, centre = np.sqrt(np.nanmean(np.concatenate(off) ** 2, axis=0))
    return {"force_x_N": float(forward), "force_y_N": float(up), "cop_x_mm": float(1e3 * centre)}


def left_out(folder: Path, paths: dict[str, FootPath]) -> dict[str, dict[str, float]]:
    """The rigid foot beside simulated stances as walked, and beside the machine's without friction; no noise."""
    foot, told = vsf_foot(), {}
    for setting in ("low", "medium", "high"):
        made = [synthetic_trial(PERSON, setting, k).truth for k in (1, 2)]
        place = folder / setting
        for name, s in zip(TRIALS, made, strict=False):
            kept = slice(None, None, EVERY)
            flat = in_plane(s.time[kept], s.poses[kept])
            seen = flat.reaction(s.force[kept], s.centre("ground")[kept])
            (place / name).mkdir(parents=True, exist_ok=True)
            pose_table(flat).to_csv(place / name / "foot.csv", index=False, float_format="%.9g")
            reaction_table(flat, *seen).to_csv(place / name / "plate.csv", index=False, float_format="%.9g")
        whole = in_plane(made[0].time, made[0].poses)
        _, up, centre = whole.reaction(made[0].force, made[0].centre("ground"))
        numbers = row_numbers(whole, foot.sole.spheres, foot.law, up, centre)
        write_sole(place / "t01", foot.sole.spheres, foot.law, numbers)
        told[f"as walked, {setting}"] = off_of(case_of(place, ("t01",), ("t02",)))
    truth = Truth(vsf_foot(joints=24, finer=4), fulcrum())
    exact = {}
    for name in TRIALS[:2]:
        load, across = truth.solve(paths[name])
        place = paths[name].pose[:, 0] + across
        kept = slice(None, None, EVERY)
        plate = np.column_stack([0.0 * load, load, np.where(load >= GATE, place, np.nan)])[kept]
        path = FootPath(paths[name].time[kept], paths[name].pose[kept])
        exact[name] = Measured(path, load[kept], place[kept], plate)
    case = gathered(folder / "machine", exact, held=exact, uses=(("t01",), ("t02",)))
    return told | {"on the machine, no friction": off_of(case)}


def answer(kind: str, folder: Path, paths: dict[str, FootPath]) -> tuple[str, dict[str, Any]]:
    """One planted effect, from the finer code to the package's foot; that of an earlier run where its file is there."""
    warnings.simplefilter("ignore")
    planted, place = PLANTED[kind], folder / kind.replace(" ", "_")
    kept = place / "answer.json"
    if kept.is_file():
        return kind, json.loads(kept.read_text(encoding="utf-8"))
    started = clock.process_time()
    made = recorded(kind, paths)
    before = recorded("nothing", paths) if planted.held else None
    truth_seconds = clock.process_time() - started
    case = gathered(place, made, LACKING if planted.field == "heel" else (), before)
    started = clock.process_time()
    found = gc.diagnose(case)
    seconds = clock.process_time() - started
    out = found.write(place / "diagnosis")
    told = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
    named, right = told["effects"], planted.right
    likely = sorted(told["probabilities"].items(), key=lambda each: -each[1])[:3]
    started = clock.process_time()
    full = refitted(planted.field, made, (CALIBRATION, EVALUATION), before)
    answered = {
        "right": list(right),
        "verdict": told["verdict"],
        "named": named,
        "found": bool(set(named) & set(right)) if right else told["verdict"] in RIGHT[kind],
        "probabilities": dict(likely),
        "absorbed": told["absorbed"],
        "where": told["where"],
        "gap": told["gap"],
        "ranking": pd.read_csv(out / "ranking.csv").iloc[:5].to_dict("records"),
        "full_model": full,
        "seconds": seconds,
        "truth_seconds": truth_seconds,
        "refit_seconds": clock.process_time() - started,
        "says": str(found),
    }
    kept.write_text(json.dumps(answered, default=str), encoding="utf-8")
    return kind, answered


RIGHT = {
    "nothing": ("no_gap",),
    "missing heel spheres": ("unknown",),
    "wrong fulcrum": ("no_gap",),
}
"""Verdicts that are right where no candidate is; to a rigid foot a fulcrum is a wrong stiffness of rows, no gap."""


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", choices=list(PLANTED))
    asked = parser.parse_args()
    kinds = [asked.only] if asked.only else list(PLANTED)
    paths = driven()
    with ProcessPoolExecutor(2) as pool:
        found = dict(pool.map(partial(answer, folder=asked.out, paths=paths), kinds))
    for kind, each in found.items():
        full = each["full_model"]
        print(
            f"{kind}: {each['verdict']} {', '.join(each['named'])} ({each['seconds']:.0f} s); keel, held out: "
            f"{full['before']['force_N']:.1f} -> {full['after']['force_N']:.1f} N"
        )
    file = ROOT / "benchmarks" / "results" / "prosthesis_gap.json"
    if asked.only:
        told = json.loads(file.read_text(encoding="utf-8"))
        told["answers"] |= found
        told.setdefault("run_again", {})[asked.only] = {"commit": commit(), **machine()}
    else:
        told = {"commit": commit(), "machine": machine(), "versions": versions({"scipy", "numba"}), "seeds": seeds()}
        told["withheld"] = {kind: asdict(planted.withheld) for kind, planted in PLANTED.items()}
        told |= {"left_out": left_out(asked.out / "left_out", paths), "answers": found}
    file.write_text(as_json(told), encoding="utf-8")


def seeds() -> dict[str, list[int]]:
    """Of the noise of each trial, by case."""
    return {kind: [100 * k + i for i in range(len(TRIALS))] for k, kind in enumerate(PLANTED)}


if __name__ == "__main__":
    main()
