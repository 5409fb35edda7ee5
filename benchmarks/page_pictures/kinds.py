"""Kinds of pages, each with the run of the command line that makes one."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from benchmarks.same_outputs.inputs import make
from benchmarks.same_outputs.recording import ROOT, RUNS, Place, first_run, runs, wanted, worked
from geocontact.analyses.catalogue import ENTRIES

BETTER = {
    "cop": "cop_compare",
    "fit": "fit_profile",
    "gap diagnose": "gap_diagnose",
    "gap gather": "gap_gather_knee",
    "id": "id_plate",
    "loadcells": "page_loadcells",
}
"""Run of a command that shows more than its first one in `same_outputs/runs.txt`."""
FURTHER_KINDS = {"compare": "page_compare", "pressure": "page_pressure", "cop_alone": "cop"}
"""Runs of commands whose pages look otherwise with other options."""
NOT_PICTURED = ("gap inject", "gap benchmark", "shoulder compare", "shoulder optimise", "shoulder study")
"""Commands whose page is one of another kind, or lasts too long to make."""

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

EVERY = runs(RUNS.read_text("utf-8") + FURTHER)


def kinds() -> dict[str, str]:
    """Run of `same_outputs/runs.txt`, or of `FURTHER`, by kind of page: one of each analysis, and a few more."""
    pictured = [each for each in ENTRIES if each.command and each.command not in NOT_PICTURED]
    names = {each.command.replace("-", "_").replace(" ", "_"): each for each in pictured}
    first = {kind: BETTER.get(each.command) or first_run(EVERY.values(), each) for kind, each in names.items()}
    return first | FURTHER_KINDS


KINDS = kinds()


def make_pages(folder: Path, kinds: Iterable[str], again: bool, jobs: int) -> dict[str, Path]:
    """Pages by kind; those that are there already are made again when asked for."""
    place = Place(folder.resolve(), ROOT)
    there = {kind: _page(place, KINDS[kind]) for kind in kinds}
    missing = [KINDS[kind] for kind, page in there.items() if again or page is None]
    if missing:
        make(place.folder / "inputs", ROOT / "meshes")
        (place.folder / "inputs" / "measured_11.csv").write_text(MEASURED, encoding="utf-8")
        place.about()  # refuses a package from elsewhere
        for run, code, seconds in worked(wanted(EVERY, missing), place, jobs):
            sys.stdout.write(f"{run.name}: exit {code}, {seconds:.1f} s\n")
    found = {kind: _page(place, KINDS[kind]) for kind in kinds}
    return {kind: page for kind, page in found.items() if page is not None}


def _page(place: Place, run: str) -> Path | None:
    """The page of a run, in a sub-folder where it has one for each recording."""
    return next(iter(sorted((place.folder / run / "out").rglob("report.html"))), None)
