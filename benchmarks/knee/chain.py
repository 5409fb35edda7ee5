"""The knee's full chain in the gap diagnosis: what is withheld, what is found: `python -m benchmarks.knee.chain OUT`.

Cases are made by finer code of its own around the same surfaces, law and weights (`benchmarks.knee.truth`), and written
as folders; each withholds one thing: 1 mm of the pose along one axis, a radius that depends on flexion, a coupling of
two load cells, or nothing. Surfaces are the sample knee's (synthetic); with `--meshes dm` those of DM of the 6th
Grand Challenge, with the mean motion measured by fluoroscopy. Loads are synthetic in both. Answers go to
benchmarks/results/knee_chain.json, by surfaces, truth and seed; those of other runs stay in it.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from benchmarks.knee import truth
from benchmarks.knee.truth import Bodies, Course, Withheld
from benchmarks.machine import machine, versions
from geocontact.gap.diagnose import diagnose
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.motion.poses import motion_from_csv, motion_from_map
from geocontact.io.text.tables import read_table
from geocontact.systems.catalogue import system_of

ROOT = Path(__file__).resolve().parents[2]
CALIBRATION, EVALUATION, FRESH, SAMPLES = 4, 2, 10, truth.CYCLE + 1
WITHHELD = {
    "nothing": (Withheld(), ""),
    "tx_1mm": (Withheld(offset=(0, 0, 0, 1e-3, 0, 0)), "motion_offset"),
    "ty_1mm": (Withheld(offset=(0, 0, 0, 0, 1e-3, 0)), "motion_offset"),
    "tz_1mm": (Withheld(offset=(0, 0, 0, 0, 0, 1e-3)), "motion_offset"),
    "radius_slow": (Withheld(transition=0.3), "axis_migration"),
    "radius_fast": (Withheld(transition=0.1), "axis_migration"),
    "crosstalk": (Withheld(coupling=("PM", "AM", 0.06)), "crosstalk"),
}
"""Name of each case: what the base is not told, and the name of it in the vocabulary."""


@dataclass(frozen=True)
class Knee:
    """Where a pair of surfaces is from: files, unit, which faces count, mean motion over the phase, finer bodies."""

    moving: Path
    fixed: Path
    unit: str
    region: str
    mean: CubicSpline
    finer: Bodies


def pose_of(rotation: Rotation, translation: np.ndarray) -> np.ndarray:
    """Coordinates (6, t) of a right knee from poses of F in T: R_TF = Ry(-rotation) Rx(-adduction) Rz(flexion)."""
    turned, tilted, bent = rotation.as_euler("YXZ").T
    return np.array([bent, -tilted, -turned, *np.asarray(translation).T])


def sample_knee(truth_on: str = "coarse") -> Knee:
    """The synthetic knee: coarse surfaces for the chain; the truth halves the edges of these, or has the medium ones.

    With the medium ones the facets are withheld besides: areas of the two differ by up to 0.8 %.
    """
    folder = ROOT / "meshes"
    motion = motion_from_csv(folder / "gait.csv")
    mean = CubicSpline(motion.time / motion.time[-1], pose_of(motion.poses.rotation, motion.poses.translation).T)
    bodies = ("femoral_component", "tibial_insert")
    femoral, insert = (read_mesh(folder / f"{name}_right_{truth_on}.stl", "mm") for name in bodies)
    finer = Bodies.of(
        (femoral.vertices, femoral.faces),
        truth.halved((insert.vertices, insert.faces), 1 if truth_on == "coarse" else 0),
    )
    names = [f"{name}_right_coarse.stl" for name in bodies]
    return Knee(*(folder / name for name in names), "mm", "", mean, finer)


def dm_knee(data: Path) -> Knee:
    """Subject DM: real surfaces and a mean motion by fluoroscopy; the truth halves the edges of the same surfaces."""
    home = data / "gc6_dm_knee"
    moving, fixed = (home / "stl" / f"{name} decimated.stl" for name in ("Femoral Component", "Tibial Insert"))
    columns = "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r"
    motion = motion_from_map(read_table(home / "fluoroscopy" / "Fluoroscopic Gait Data.sto"), columns, angles="rad")
    phase = (motion.time - motion.time[0]) / (motion.time[-1] - motion.time[0])
    mean = CubicSpline(phase, pose_of(motion.poses.rotation, motion.poses.translation).T)
    femoral, insert = (read_mesh(file, "m") for file in (moving, fixed))
    finer = Bodies.of((femoral.vertices, femoral.faces), truth.halved((insert.vertices, insert.faces)), 0.25)
    return Knee(moving, fixed, "m", "ny>0.25", mean, finer)


def settings(knee: Knee, trials: list[str], calibration: int) -> str:
    """case.toml."""
    lines = [
        "format = 1",
        'system = "geocontact.systems.knee_full_chain:CELLS"',
        f"calibration = {json.dumps(trials[:calibration])}",
        f"evaluation = {json.dumps(trials[calibration:])}",
        "[noise]",
        *(f"{name} = {truth.NOISE}" for name in truth.CELLS),
        "[constants]",
        f"R = {truth.RADIUS}",
        f"threshold = {truth.THRESHOLD}",
        "side = 1",
        f"cell_posterior = {truth.ROWS[0]}",
        f"cell_anterior = {truth.ROWS[1]}",
        "[mesh.moving]",
        f'file = "{knee.moving.name}"',
        f'unit = "{knee.unit}"',
        "[mesh.fixed]",
        f'file = "{knee.fixed.name}"',
        f'unit = "{knee.unit}"',
        f'region = "{knee.region}"',
        "[parameters.E_star]",
        f"start = {0.7 * truth.MODULUS}",
        f"lower = {0.05 * truth.MODULUS}",
        f"upper = {20.0 * truth.MODULUS}",
        'unit = "Pa"',
    ]
    return "\n".join(lines) + "\n"


def write_case(folder: Path, knee: Knee, courses: list[Course], withheld: Withheld, calibration: int) -> Path:
    """A gap case that anybody may diagnose; what is withheld stands nowhere in it."""
    (folder / "trials").mkdir(parents=True)
    names = [f"t{i + 1:02d}" for i in range(len(courses))]
    for name, course in zip(names, courses, strict=True):
        columns = {"time [s]": course.time[:: truth.FINER]}
        pose = zip(truth.POSE.items(), course.measured(withheld), strict=True)
        columns |= {f"{channel} [{unit}]": row for (channel, unit), row in pose}
        columns |= {f"{c} [N]": row for c, row in zip(truth.CELLS, course.cells(withheld).T, strict=True)}
        pd.DataFrame(columns).to_csv(folder / "trials" / f"{name}.csv", index=False, float_format="%.9g")
    for file in (knee.moving, knee.fixed):
        shutil.copy(file, folder / file.name)
    (folder / "case.toml").write_text(settings(knee, names, calibration), encoding="utf-8")
    return folder


def courses_of(knee: Knee, seed: int, count: int, samples: int) -> list[Course]:
    return [Course.drawn(knee.finer, knee.mean, np.random.default_rng([seed, i]), samples) for i in range(count)]


def answer(folder: Path) -> dict[str, object]:
    """What the diagnosis says of a case, in short."""
    began = time.perf_counter()
    case = read_gap_case(folder)
    system = system_of(case)
    ready = time.perf_counter() - began
    found = diagnose(case, system)
    d, tried = found.diagnosis, found.attribution
    best = sorted(tried.contenders, key=lambda one: -one.judged.nats)[:6]
    return {
        "verdict": d.verdict,
        "effects": list(d.effects),
        "gains_nats": {one.label: round(one.judged.nats - tried.base.judged.nats, 1) for one in best},
        "probabilities": {k: round(p, 3) for k, p in list(d.probabilities.items())[:5]},
        "ambiguity": list(d.ambiguity),
        "absorbed": list(d.absorbed),
        "where": [[w.channel, [round(p, 2) for p in w.phase], round(w.share, 2)] for w in d.where],
        "reduction": {k: [round(g.reduction, 3), *(round(c, 3) for c in g.ci95)] for k, g in d.gap.items()},
        "rmse": {
            k: [round(g.rmse_before, 2), round(g.rmse_after, 2), round(g.noise_floor, 2)] for k, g in d.gap.items()
        },
        "parameters": {k: [e.value, *e.ci95] for k, e in d.parameters.items()},
        "remarks": list(d.remarks),
        "surfaces_s": round(ready, 1),
        "diagnosis_s": round(d.seconds, 1),
    }


def run(
    knee: Knee,
    out: Path,
    names: tuple[str, ...] = tuple(WITHHELD),
    seed: int = 1,
    trials: tuple[int, int, int] = (CALIBRATION, EVALUATION, FRESH),
    samples: int = SAMPLES,
) -> dict[str, dict[str, object]]:
    """Cases written to `out` and diagnosed; answers by name."""
    calibration, evaluation, fresh = trials
    courses = courses_of(knee, seed, sum(trials), samples)
    measured, unseen = courses[: calibration + evaluation], courses[calibration + evaluation :]
    found: dict[str, dict[str, object]] = {}
    for name in names:
        withheld, label = WITHHELD[name]
        said = answer(write_case(out / name, knee, measured, withheld, calibration))
        real = truth.true_reduction(knee.finer, measured[:calibration], unseen, withheld) if fresh and label else None
        said |= {"withheld": label}
        if real is not None:
            said["true_reduction"] = dict(zip(truth.CELLS, np.round(real, 3).tolist(), strict=True))
        found[name] = said
        print(f"{name}: {json.dumps(said)}", flush=True)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="folder that gets the cases and answers.json")
    parser.add_argument("--meshes", choices=["sample", "dm"], default="sample")
    parser.add_argument(
        "--truth", choices=["coarse", "medium"], default="coarse", help="surfaces of the sample's truth"
    )
    parser.add_argument("--only", nargs="*", choices=list(WITHHELD), default=list(WITHHELD))
    parser.add_argument("--seed", type=int, default=1)
    default = Path(os.environ.get("GEOCONTACT_DATA") or ROOT.parent / "shared" / "data")
    parser.add_argument(
        "--trials", type=int, nargs=3, metavar=("CALIBRATION", "EVALUATION", "FRESH"),
        help=f"how many ({CALIBRATION} {EVALUATION} {FRESH}; of DM 3 1 0, as its surfaces take long)",
    )  # fmt: skip
    parser.add_argument("--results", type=Path, default=ROOT / "benchmarks" / "results")
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data (%(default)s)")
    given = parser.parse_args()
    if given.out.exists():
        parser.error(f"{given.out} is there already; name another folder")
    knee = sample_knee(given.truth) if given.meshes == "sample" else dm_knee(given.data)
    usual = (CALIBRATION, EVALUATION, FRESH) if given.meshes == "sample" else (3, 1, 0)
    trials = tuple(given.trials or usual)
    found = run(knee, given.out, tuple(given.only), given.seed, trials)
    (given.out / "answers.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    surfaces = f"{given.meshes}, truth {given.truth}" if given.meshes == "sample" else given.meshes
    kept(given.results / "knee_chain.json", f"{surfaces}, seed {given.seed}", given.seed, trials, found)


def kept(file: Path, name: str, seed: int, trials: tuple[int, ...], found: dict[str, dict[str, object]]) -> None:
    """The file with this run's answers put into it; cases that were not run again keep theirs."""
    report = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {"runs": {}}
    before = report["runs"].get(name, {}).get("cases", {})
    report["runs"][name] = {
        "machine": machine(),
        "versions": versions({"scipy", "libigl"}),
        "seed": seed,
        "trials": dict(zip(("calibration", "evaluation", "fresh"), trials, strict=True)) | {"samples": SAMPLES},
        "noise_N": truth.NOISE,
        "cases": before | found,
    }
    file.write_text(json.dumps(report, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
