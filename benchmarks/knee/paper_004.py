"""What source paper 004 reports beside what the same subject's data give: `python -m benchmarks.knee.paper_004 --data
DIR`.

Every figure comes from a command that a user can type; the page docs/reference/paper_004.md holds them. DIR is the
folder of the real data (gc4_jw_knee, gc4_jw_predsim_workshop).
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.machine import machine, versions

HERE = Path(__file__).resolve().parents[1]
FEMUR, INSERT = "Femoral Component.stl", "Tibial Insert.stl"
Z, SIDE_VIEW = ("--axis", "0,0,0,0,0,1"), "--sagittal=-y,x"  # the condyles lie at +x, the flange at -x
FITS = {
    "all faces": (FEMUR, "cylinder", ()),
    "bearing": (FEMUR, "cylinder", (*Z, "--region", "outward>0.5")),
    "bearing, facing down": (FEMUR, "cylinder", (*Z, "--region", "outward>0.5 and ny<0")),
    "distal": (FEMUR, "cylinder", (*Z, SIDE_VIEW, "--region", "outward>0.5 and -40<flexion<30")),
    "posterior": (FEMUR, "cylinder", (*Z, "--region", "outward>0.5 and nx>0.5")),
    "medial condyle, posterior (+z)": (FEMUR, "sphere", ("--region", "nx>0.5 and z>0.01 and x>0.015")),
    "lateral condyle, posterior (-z)": (FEMUR, "sphere", ("--region", "nx>0.5 and z<-0.01 and x>0.015")),
    "hip head": ("Hip Implant Femoral Component.stl", "sphere", ()),
    "hip cup, back": ("Hip Implant Acetabular Cup.stl", "sphere", ()),
    "patellar button": ("Patellar Button.stl", "sphere", ()),
    "insert, medial dish (+z)": (INSERT, "sphere", ("--region", "ny>0.8 and z>0.01 and abs(x)<0.015")),
    "insert, lateral dish (-z)": (INSERT, "sphere", ("--region", "ny>0.8 and z<-0.01 and abs(x)<0.015")),
}
"""Mesh, shape and options; lengths in m."""
THRESHOLDS = (0.1, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
STUDIED = (1.699, 2.811)  # s, the study's cycle of og1
COARSE = ("Femoral_Component_simpler.stl", "Tibial_Insert_simpler_superior.stl")
IDENTIFIED = {
    "R = 37 mm": ("--radius-mm", "37"),
    "R of flexion": (),
    "R = 37 mm, lag free": ("--radius-mm", "37", "--free", "lag"),
    "R = 37 mm, threshold free": ("--radius-mm", "37", "--free", "threshold"),
}


def main() -> None:
    """Run everything, print it, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.knee.paper_004", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        report = {"machine": machine(), "versions": versions({"scipy"}), **figures(options.data, Path(folder))}
    text = json.dumps(report, indent=1, ensure_ascii=False)
    print(text)
    (options.out / "paper_004.json").write_text(text + "\n", encoding="utf-8")


def figures(data: Path, work: Path) -> dict[str, object]:
    """All figures of the page."""
    return {
        "fits": {name: fitted(data, work / f"fit {k}", *FITS[name]) for k, name in enumerate(FITS)},
        "sagittal radius [mm]": profile(data, work),
        "area, workshop's meshes": areas(data, work, "coarse"),
        "area, original meshes": areas(data, work, "fine"),
        "modulus": {name: modulus(data, work, name) for name in IDENTIFIED},
        "prediction": predictions(data, work),
        "load cells": load_cells(data, work),
        "peaks of og1, medial and lateral [N]": og1_peaks(data),
    }


def geocontact(*words: object) -> None:
    """One command, as typed; one whose result, or one of whose cases, contradicts its data is written all the same."""
    command = [sys.executable, str(HERE.parent / "cli.py"), *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    written = done.stdout.startswith("the result contradicts its data") or "contradict their data" in done.stderr
    if done.returncode and not written:
        raise SystemExit(f"{' '.join(command)}\n{done.stderr}")


def fitted(data: Path, out: Path, mesh: str, shape: str, options: Sequence[str]) -> dict[str, object]:
    """A shape through a patch of one of the subject's implants; the back of the cup from a first fit of all of it."""
    file = data / "gc4_jw_knee" / "stl" / mesh
    words = ("fit", file, "--shape", shape, "--unit", "m", "--out")
    geocontact(*words, out, *options)
    if "Cup" in mesh:
        geocontact(*words, out / "back", "--centre", out / "fit.json", "--region", "outward>0.9")
        out = out / "back"
    told = json.loads((out / "fit.json").read_text(encoding="utf-8"))
    kept = ("radius_mm", "radius_ci95_mm", "rms_mm", "mean_abs_mm", "max_abs_mm", "points", "inliers", "arc_deg")
    return {name: rounded(told[name]) for name in kept if told.get(name) is not None}


def profile(data: Path, work: Path) -> dict[str, dict[str, float]]:
    """Sagittal radius of both condyles by flexion [deg]; the file is used again by the modulus."""
    mesh = data / "gc4_jw_knee" / "stl" / FEMUR
    options = (*Z, SIDE_VIEW, "--region", "outward>0.5", "--split", "z", "--medial", "+", "--profile=-20:80:5")
    geocontact("fit", mesh, "--shape", "cylinder", "--unit", "m", *options, "--out", work / "profile")
    table = read(work / "profile" / "profile.csv")
    return {
        side: {f"{angle:g}": round(r, 2) for angle, r in zip(rows["flexion [deg]"], rows["radius [mm]"], strict=True)}
        for side, rows in table.groupby("side")
    }


def areas(data: Path, work: Path, which: str, thresholds: Sequence[float] = THRESHOLDS) -> dict[str, list[float]]:
    """Least and greatest area over trial og1 by threshold [mm^2], medial at +z; poses of the workshop."""
    workshop = data / "gc4_jw_predsim_workshop"
    original = data / "gc4_jw_knee" / "stl"
    pair = [workshop / name for name in COARSE] if which == "coarse" else [original / FEMUR, original / INSERT]
    joint = ("--osim", workshop / "KneeProsthesis.osim", "--joint", "knee_joint", "--angles", "deg")
    levels = ",".join(f"{t:g}" for t in thresholds)
    options = ("--moving", "parent", "--split", "z", "--medial", "+", "--threshold", levels, "--region", "ny>0.25")
    motion = ("--motion", workshop / "KneeProsthesis.mot")
    geocontact("area", *pair, "--unit", "m", *motion, *joint, *options, "--out", work / which)
    table = read(work / which / "area.csv")
    found: dict[str, list[float]] = {"signed": [str(table["signed"].iloc[0])]}
    for threshold, rows in table.groupby("threshold [mm]"):
        values = rows["area_fixed [mm^2]"]
        found[f"{threshold:g}"] = [round(float(values.min()), 1), round(float(values.max()), 1)]
    return found


def modulus(data: Path, work: Path, name: str) -> dict[str, object]:
    """E* on trial og1: area of the workshop's meshes, force in pound-force, all frames."""
    workshop, out = data / "gc4_jw_predsim_workshop", work / f"modulus {name}"
    options: list[object] = list(IDENTIFIED[name])
    if not options:
        follow = ("--flexion", workshop / "KneeProsthesis.mot", "--map", "flexion=-knee_flexion", "--angles", "deg")
        options = ["--profile", work / "profile" / "profile.csv", *follow]
    words = ("--area", work / "coarse" / "area.csv", "--force", workshop / "KCF_ref.mot", "--unit", "lbf")
    geocontact("modulus", *words, "--length-mm", "60", "--poisson", "0.25,0.46", *options, "--out", out)
    told = json.loads((out / "modulus.json").read_text(encoding="utf-8"))
    table = read(out / "sensitivity.csv").query("side == 'total'")
    sides = {"total": told, **told["compartments"]}
    return {
        "E* [MPa]": {side: rounded(each["E_star_Pa"] * 1e-6) for side, each in sides.items()},
        "95 % [MPa]": {
            side: [rounded(v * 1e-6) for v in ends] for side, each in sides.items() if (ends := each["E_star_ci95_Pa"])
        },
        "RMSE [N]": {side: round(each["rmse_N"], 1) for side, each in sides.items()},
        "R2": {side: round(each["r2"], 3) for side, each in sides.items()},
        "E [MPa]": {ratio: rounded(value * 1e-6) for ratio, value in told["E_Pa"].items()},
        "singular values of E, nu": [round(v, 6) for v in told["identifiability"]["E, nu"]["singular_values"]],
        "intervals": {side: intervals_of(each["intervals"]) for side, each in sides.items()},
        "threshold sensitivity [MPa, R2]": {
            reading: {
                f"{t:g}": [rounded(e * 1e-6), round(float(r2), 3)]
                for t, e, r2 in zip(rows["threshold [mm]"], rows["E_star [Pa]"], rows["r2 [-]"], strict=True)
            }
            for reading, rows in table.groupby("reading", sort=False)
        },
    }


def predictions(data: Path, work: Path) -> dict[str, dict[str, dict[str, float]]]:
    """Force that was not used, by E* identified on another part of og1: R = 37 mm, 4 mm, workshop's meshes.

    There is no second trial with poses and forces. What there is: the two halves of the cycle, and the stretch before
    it, for which the force is measured but the pose is a hinge: flexion from markers, all else held by the model.
    """
    workshop = data / "gc4_jw_predsim_workshop"
    table = read(work / "coarse" / "area.csv")
    middle = 0.5 * (table["time [s]"].min() + table["time [s]"].max())
    joint = ("--osim", workshop / "KneeProsthesis.osim", "--joint", "knee_joint", "--angles", "deg")
    options = ("--moving", "parent", "--split", "z", "--medial", "+", "--region", "ny>0.25")
    motion, pair = ("--motion", workshop / "jw_ngait_og1_new_v4_converted.mot"), [workshop / name for name in COARSE]
    geocontact("area", *pair, "--unit", "m", *motion, *joint, *options, "--out", work / "hinge")
    hinge = read(work / "hinge" / "area.csv")
    parts = {
        "cycle": table,
        "first half": table[table["time [s]"] <= middle],
        "second half": table[table["time [s]"] > middle],
        "before, hinge": hinge[hinge["time [s]"] < table["time [s]"].min()],
    }
    for name, rows in parts.items():
        rows[rows["threshold [mm]"] == 4.0].to_csv(work / f"{name}.csv", index=False)
    pairs = (("first half", "second half"), ("second half", "first half"), ("cycle", "before, hinge"))
    return {f"{used} → {told}": predicted(data, work, used, told) for used, told in pairs}


def predicted(data: Path, work: Path, used: str, unseen: str) -> dict[str, dict[str, float]]:
    """RMSE [N] and R2 of each side."""
    force, out = data / "gc4_jw_predsim_workshop" / "KCF_ref.mot", work / f"{used} {unseen}"
    words = ("--area", work / f"{used}.csv", "--force", force, "--unit", "lbf", "--radius-mm", "37", "--bootstrap", "0")
    geocontact("modulus", *words, "--predict-area", work / f"{unseen}.csv", "--predict-force", force, "--out", out)
    told = json.loads((out / "modulus.json").read_text(encoding="utf-8"))["prediction"]
    return {side: {"RMSE [N]": round(p["rmse_N"], 1), "R2": round(p["r2"], 3)} for side, p in told.items()}


def og1_peaks(data: Path) -> list[float]:
    """Of og1 between the times that the study gives for its normal gait."""
    from geocontact.io.recordings.area_table import read_force_curves

    found = read_force_curves(data / "gc4_jw_predsim_workshop" / "KCF_ref.mot", "lbf", {})
    inside = (found.time >= STUDIED[0]) & (found.time <= STUDIED[1])
    return [round(float(found.forces[side][inside].max()), 1) for side in ("medial", "lateral")]


def intervals_of(told: dict[str, dict]) -> dict[str, dict[str, object]]:
    """Each free number in SI units, with its interval by profile likelihood and by block bootstrap.

    Without them where the result contradicts its data.
    """
    kept = ("value", "profile_likelihood", "block_bootstrap")
    return {name: {key: rounded(each[key]) for key in kept if each.get(key) is not None} for name, each in told.items()}


def load_cells(data: Path, work: Path) -> dict[str, object]:
    """Peaks of trial og3 [N] by the published regression, and by every other convention that we could think of."""
    import numpy as np
    from scipy.signal import butter, filtfilt

    from geocontact.io.recordings.load_cells import read_load_cells
    from geocontact.loads.loadcells import PUBLISHED

    file = data / "gc4_jw_knee" / "knee_forces" / "jw_ngait_og3_knee_forces.csv"
    geocontact("loadcells", file, "--unit", "lbf", "--cycles", "stance", "--out", work / "cells")
    peaks = read(work / "cells" / "forces.csv").max()
    cells = read_load_cells(file, PUBLISHED.cells, "lbf", {})
    weights = np.array([PUBLISHED.medial, PUBLISHED.lateral]).T
    low = butter(4, 6.0 / (0.5 / np.median(np.diff(cells.time))))
    swapped = {f"order {' '.join(np.array(PUBLISHED.cells)[list(o)])}": cells.forces[:, list(o)] for o in orders()}
    ways = {
        **swapped,
        "least of each cell taken off": cells.forces - cells.forces.min(axis=0),
        "low-pass 6 Hz, fourth order": filtfilt(*low, cells.forces, axis=0),
    }
    tried = {name: [round(float(v), 1) for v in (forces @ weights).max(axis=0)] for name, forces in ways.items()}
    pairs = cells.forces @ np.array([[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]]).T
    tried["two cells a side, no weights"] = [round(float(v), 1) for v in pairs.max(axis=0)]
    for one in ensemble(work):
        tried |= one
    return {
        "peaks [N]": {side: round(float(peaks[f"{side} [N]"]), 1) for side in ("medial", "lateral", "total")},
        "other conventions, medial and lateral [N]": tried,
    }


def orders() -> list[tuple[int, ...]]:
    """Every other order of the four cells."""
    from itertools import permutations

    return [order for order in permutations(range(4)) if order != (0, 1, 2, 3)]


def ensemble(work: Path) -> list[dict[str, list[float]]]:
    """Peaks of the mean stance."""
    table = read(work / "cells" / "ensemble.csv")
    values = [round(float(table[f"{side}_mean [N]"].max()), 1) for side in ("medial", "lateral")]
    return [{"mean of the stances": values}]


def read(path: Path):
    """A table of results."""
    import pandas as pd

    return pd.read_csv(path, comment="#")


def rounded(value: object) -> object:
    """Four digits."""
    if isinstance(value, list):
        return [rounded(each) for each in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


if __name__ == "__main__":
    main()
