"""Real recordings as gap cases, and what the diagnosis says of them: `python -m benchmarks.gap.real_gaps --data DIR`.

Nobody knows what the models of these cases lack, so no answer is right or wrong here; each is told beside those under
other assumptions about what nobody measured. docs/reference/gap_real_data.md holds the figures.
"""

from __future__ import annotations

import argparse
import json
import os
import re
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.knee import real as real_knee
from benchmarks.knee.paper_004 import geocontact
from benchmarks.machine import machine, versions
from benchmarks.prosthesis import real_foot
from benchmarks.prosthesis.real_foot import WALKS, Placement
from geocontact.data.errors import InputError
from geocontact.gap.case.admission import admitted
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of

HERE = Path(__file__).resolve().parents[1]
KNEES = {
    "as stated": ("workshop", 4.0, "quarters 1 and 3"),
    "threshold 0.5 mm": ("workshop", 0.5, "quarters 1 and 3"),
    "threshold 1 mm": ("workshop", 1.0, "quarters 1 and 3"),
    "threshold 2 mm": ("workshop", 2.0, "quarters 1 and 3"),
    "original meshes": ("original", 4.0, "quarters 1 and 3"),
    "fitted to quarters 2 and 4": ("workshop", 4.0, "quarters 2 and 4"),
    "fitted to the first half": ("workshop", 4.0, "first half"),
}
"""Meshes, threshold [mm], and the stretches of the cycle that are fitted to."""
FEET: Mapping[str, Mapping[str, tuple[Placement, tuple[str, ...]]]] = {
    "overground": {
        "as stated": (Placement(), ()),
        "rigid up to the toe": (Placement(front="toe"), ()),
        "spheres 2 mm deep": (Placement(sink=0.002), ()),
        "spheres 10 mm deep": (Placement(sink=0.010), ()),
        "threshold speed 0.05 m/s": (Placement(threshold_speed=0.05), ()),
        "fitted to left 1 and right 2": (Placement(), ("left_1", "right_2")),
    },
    "treadmill": {
        "as stated": (Placement(), ()),
        "rigid up to the midfoot": (Placement(front="midfoot"), ()),
        "spheres 2 mm deep": (Placement(sink=0.002), ()),
        "spheres 10 mm deep": (Placement(sink=0.010), ()),
        "threshold speed 0.05 m/s": (Placement(threshold_speed=0.05), ()),
        "fitted to right 2 and left 2": (Placement(), ("right_2", "left_2")),
    },
}
"""Placement, and the steps that are fitted to where they are others."""
KEPT = ("verdict", "effects", "probabilities", "ambiguity", "absorbed", "where", "gap", "parameters", "remarks")


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.real_gaps", description=__doc__.splitlines()[0])
    default = Path(os.environ.get("GEOCONTACT_DATA") or HERE.parents[1] / "shared" / "data")
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data (%(default)s)")
    parser.add_argument("--cases", type=Path, help="keep the cases and their diagnoses in this new folder")
    parser.add_argument("--out", type=Path, default=HERE / "results", help="folder for the JSON")
    parser.add_argument("--stated-only", action="store_true", help="leave the other assumptions out")
    return parser.parse_args()


def build(data: Path, work: Path, stated_only: bool) -> dict[str, dict[str, Any]]:
    """Cases below `work/cases`, and how each was made, by subject and assumption."""
    made: dict[str, dict[str, Any]] = {"knee": {}, **{name: {} for name in FEET}}
    for name, (meshes, threshold, split) in KNEES.items():
        if stated_only and name != "as stated":
            continue
        areas = work / f"areas_{meshes}"
        if not areas.exists():
            real_knee.write_areas(data, areas, meshes)
        made["knee"][name] = real_knee.write_case(data, areas, place(work, "knee", name), threshold, split)
    for walk, variants in FEET.items():
        for name, (placement, fitted) in variants.items():
            if not stated_only or name == "as stated":
                folder = place(work, walk, name)
                made[walk][name] = real_foot.write_case(data, folder, WALKS[walk], placement, fitted)
    return made


def place(work: Path, subject: str, assumption: str) -> Path:
    """Folder of a case."""
    return work / "cases" / re.sub(r"[^\w.]+", "_", f"{subject} {assumption}")


def set_aside(work: Path) -> dict[str, str]:
    """Cases that a diagnosis refuses, such as one step held out, and why; they are moved to `work/refused`."""
    refused: dict[str, str] = {}
    (work / "refused").mkdir()
    for folder in sorted((work / "cases").iterdir()):
        case = read_gap_case(folder)
        try:
            admitted(case, system_of(case))
        except InputError as error:
            refused[folder.name] = str(error)
            folder.rename(work / "refused" / folder.name)
    return refused


def diagnosed(data: Path, work: Path, stated_only: bool = False) -> dict[str, dict[str, Any]]:
    """What the diagnosis says of each case, or why it refuses it, and how the case was made."""
    made = build(data, work, stated_only)
    refused = set_aside(work)
    geocontact("gap", "diagnose", work / "cases", "--many", "--bare", "--workers", "1", "--out", work / "said")
    for subject, variants in made.items():
        for name, about in variants.items():
            here = place(work, subject, name).name
            if here in refused:
                variants[name] = {"made": about, "refused": refused[here]}
                continue
            file = work / "said" / here / "diagnosis.json"
            said = json.loads(file.read_text(encoding="utf-8"))
            variants[name] = {"made": about, **{key: said[key] for key in KEPT}}
    return made


def main() -> None:
    """Build, diagnose, print, write the JSON."""
    options = arguments()
    with TemporaryDirectory() as folder:
        work = options.cases or Path(folder)
        found = diagnosed(options.data, work, options.stated_only)
    report = {"machine": machine(), "versions": versions({"scipy"}), "cases": rounded(found)}
    text = json.dumps(report, indent=1, ensure_ascii=False)
    for subject, variants in found.items():
        for name, said in variants.items():
            print(f"{subject}, {name}: {said.get('refused') or ' '.join([said['verdict'], *said['effects']])}")
    (options.out / "real_gaps.json").write_text(text + "\n", encoding="utf-8")


def rounded(value: Any) -> Any:
    """The same with six significant digits: more is not told by the data."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(each) for each in value]
    return value


if __name__ == "__main__":
    main()
