"""Force against area in an instrumented knee as gap cases: trial og1 of subject JW, as the workshop's data have it.

Poses are those that the workshop's authors simulated in a tracking problem, 41 frames over one cycle of 1.145 s; forces
are measured at 120 Hz on the same clock. There is one cycle: a trial is a stretch of it. Poses are interpolated to the
times of the forces (monotone cubic, each coordinate by itself), `geocontact area` computes areas there, and
`geocontact gap gather` makes the case.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

from benchmarks.knee.paper_004 import COARSE, FEMUR, INSERT, geocontact
from geocontact.io.recordings.area_table import read_force_curves
from geocontact.io.text.tables import read_table

HOME = "gc4_jw_predsim_workshop"
RADIUS = 0.037  # m, the study's
MODULUS = {"start": 1.5e6, "lower": 1e4, "upper": 1e9}  # Pa
THRESHOLDS = (0.5, 1.0, 2.0, 4.0, 6.0)  # mm
SPLITS = {
    "quarters 1 and 3": (4, (0, 2)),
    "quarters 2 and 4": (4, (1, 3)),
    "first half": (2, (0,)),
    "second half": (2, (1,)),
    "thirds 1 and 3": (3, (0, 2)),
}
"""Into how many stretches the cycle is cut, and which of them are fitted to."""
ANGLES = {"flexion": -1.0, "adduction": 1.0}
"""Sign of the joint's coordinates in the case: the joint's flexion is negative where the knee is bent."""


def poses(data: Path) -> pd.DataFrame:
    """Joint coordinates at the times of the forces, degrees and m as in the file."""
    home = data / HOME
    table = read_table(home / "KneeProsthesis.mot")
    force = read_force_curves(home / "KCF_ref.mot", "lbf", {})
    at = force.time[(force.time >= table.time[0]) & (force.time <= table.time[-1])]
    columns = {name: PchipInterpolator(table.time, table.column(name))(at) for name in table.channels}
    return pd.DataFrame({"time": at} | columns)


def write_areas(data: Path, work: Path, meshes: str) -> None:
    """`work/area`: areas of both sides at every threshold, by `geocontact area`."""
    work.mkdir(parents=True)
    moved = poses(data)
    head = ["moved", "version=1", f"nRows={len(moved)}", f"nColumns={moved.shape[1]}", "inDegrees=yes", "endheader"]
    rows = moved.to_csv(sep="\t", index=False, float_format="%.10g", lineterminator="\n")
    (work / "moved.mot").write_text("\n".join([*head, rows]), encoding="utf-8")
    home, original = data / HOME, data / "gc4_jw_knee" / "stl"
    pair = [home / name for name in COARSE] if meshes == "workshop" else [original / FEMUR, original / INSERT]
    joint = ("--osim", home / "KneeProsthesis.osim", "--joint", "knee_joint", "--angles", "deg", "--moving", "parent")
    sides = ("--split", "z", "--medial", "+", "--region", "ny>0.25")
    levels = ("--threshold", ",".join(f"{t:g}" for t in THRESHOLDS))
    geocontact(
        "area", *pair, "--unit", "m", "--motion", work / "moved.mot", *joint, *sides, *levels, "--out", work / "area"
    )


def write_case(data: Path, work: Path, folder: Path, threshold: float, split: str) -> dict[str, object]:
    """A gap case in `folder` of the areas in `work` at a threshold [mm]; how its trials were cut."""
    moved = poses(data)
    pieces, fitted = SPLITS[split]
    names = [f"part_{k + 1}" for k in range(pieces)]
    sources = folder.parents[1] / "sources" / folder.name
    sources.mkdir(parents=True)
    cut = {
        name: moved.iloc[rows] for name, rows in zip(names, np.array_split(np.arange(len(moved)), pieces), strict=True)
    }
    for name, rows in cut.items():
        angles = {f"{k} [rad]": sign * np.radians(rows[f"knee_{k}"]) for k, sign in ANGLES.items()}
        table = pd.DataFrame({"time [s]": rows["time"]} | angles)
        table.to_csv(sources / f"{name}.csv", index=False, float_format="%.9g")
    calibration = [names[k] for k in fitted]
    text = settings(data / HOME / "KCF_ref.mot", work / "area" / "area.csv", names, calibration, threshold)
    (sources / "gather.toml").write_text(text, encoding="utf-8")
    geocontact("gap", "gather", sources / "gather.toml", "--out", folder)
    return {
        "calibration": calibration,
        "times_s": {name: [float(rows["time"].iloc[0]), float(rows["time"].iloc[-1])] for name, rows in cut.items()},
        "samples": {name: len(rows) for name, rows in cut.items()},
    }


def settings(forces: Path, areas: Path, names: list[str], calibration: list[str], threshold: float) -> str:
    """gather.toml."""
    lines = ["format = 1", 'system = "knee"', f"calibration = {calibration}"]
    lines += [f"evaluation = {[name for name in names if name not in calibration]}", "[constants]", f"R = {RADIUS}"]
    lines += ["[parameters.E_star]", *(f"{key} = {value!r}" for key, value in MODULUS.items()), 'unit = "Pa"']
    for name in names:
        lines += [f"[from.{name}]", f'inputs = "{name}.csv"', f'forces = "{forces}"', 'force_unit = "lbf"']
        lines += [f'areas = "{areas}"', f"threshold = {1e-3 * threshold!r}"]
    return "\n".join([*lines, ""]).replace("'", '"')
