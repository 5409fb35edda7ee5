"""Kinds of pages, each with the run of the command line that makes one."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from benchmarks.same_outputs.inputs import make
from benchmarks.same_outputs.recording import ROOT, RUNS, Place, runs, wanted, worked

KINDS = {
    "area": "area_split",
    "cohort": "cohort",
    "compare": "page_compare",
    "pressure": "page_pressure",
    "fit": "fit_profile",
    "knee_settle": "knee_settle",
    "loadcells": "page_loadcells",
    "cop": "cop_compare",
    "cop_alone": "cop",
    "modulus": "modulus",
    "mat": "mat_plain",
    "ik": "ik",
    "id": "id_plate",
    "elbow_simulate": "elbow_simulate",
    "elbow_fit": "elbow_fit",
    "elbow_compare": "elbow_compare",
    "elbow_design": "elbow_design",
    "elbow_population": "elbow_population",
    "scale": "scale",
    "prosthesis_scale": "prosthesis_scale",
    "markers": "markers",
    "joint": "joint",
    "standing": "standing_calibrate",
    "standing_predict": "standing_predict",
    "standing_compare": "standing_compare",
    "standing_design": "standing_design",
    "standing_device": "standing_device",
    "prosthesis_simulate": "prosthesis_simulate",
    "prosthesis_calibrate": "prosthesis_calibrate",
    "prosthesis_compare": "prosthesis_compare",
    "prosthesis_design": "prosthesis_design",
    "shoulder_simulate": "shoulder_simulate",
    "gather": "gap_gather_knee",
    "gap": "gap_diagnose",
    "confuse": "gap_confuse",
}
"""Run of `same_outputs/runs.txt`, or of `FURTHER`, by kind of page."""

KNEE = (
    "area inputs/meshes/femoral_component_right_coarse.stl inputs/meshes/tibial_insert_right_coarse.stl --unit mm "
    "--motion inputs/area/gait_11.csv"
)
FURTHER = f"""
page_compare: {KNEE} --threshold 4 --compare inputs/measured_11.csv --tolerance 3%
page_pressure: {KNEE} --split z --side right --region "ny>0.25" --pressure --modulus 500MPa --poisson 0.46
page_loadcells: loadcells inputs/knee/walk.csv --unit N --cycles stride --part 60% --body-mass 72.6
"""
MEASURED = "time [s], area_fixed [mm^2]\n0,2080\n0.2,2275\n0.5,1880\n0.8,2380\n1,2080\n"


def make_pages(folder: Path, kinds: Iterable[str], again: bool, jobs: int) -> dict[str, Path]:
    """Pages by kind; those that are there already are made again when asked for."""
    place = Place(folder.resolve(), ROOT)
    there = {kind: _page(place, KINDS[kind]) for kind in kinds}
    missing = [KINDS[kind] for kind, page in there.items() if again or page is None]
    if missing:
        make(place.folder / "inputs", ROOT / "meshes")
        (place.folder / "inputs" / "measured_11.csv").write_text(MEASURED, encoding="utf-8")
        place.about()  # refuses a package from elsewhere
        every = runs(RUNS.read_text("utf-8") + FURTHER)
        for run, code, seconds in worked(wanted(every, missing), place, jobs):
            sys.stdout.write(f"{run.name}: exit {code}, {seconds:.1f} s\n")
    found = {kind: _page(place, KINDS[kind]) for kind in kinds}
    return {kind: page for kind, page in found.items() if page is not None}


def _page(place: Place, run: str) -> Path | None:
    """The page of a run, in a sub-folder where it has one for each recording."""
    return next(iter(sorted((place.folder / run / "out").rglob("report.html"))), None)
