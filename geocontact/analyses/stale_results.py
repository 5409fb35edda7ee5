"""What an earlier run wrote into a folder of results and the present run does not write again."""

from __future__ import annotations

import json
import re
from pathlib import Path

RUN = "run.json"
AREA = ("area.csv", "area.parquet", "area.png", "area.svg", "comparison.csv", "distances.npz", "report.html")
PRESSURE = ("pressure.csv", "pressure.parquet", "pressure.png", "pressure.svg", "pressure.npz")
COP = (
    "cop.csv",
    "cop.parquet",
    "cop.png",
    "cop.svg",
    "comparison.csv",
    "comparison.parquet",
    "zones.csv",
    "zones.parquet",
)
LOADCELLS = (
    *(f"{name}.{ending}" for name in ("forces", "cycles", "ensemble", "styles") for ending in ("csv", "parquet")),
    *(f"{name}.{ending}" for name in ("loadcells", "ensemble") for ending in ("png", "svg")),
    "report.html",
)
FIT = (
    "fit.json", "fit.png", "fit.svg", "fit.vtp", "profile.csv", "profile.parquet", "profile.png", "profile.svg",
    "report.html",
)  # fmt: skip
MODULUS = (
    "modulus.json", "modulus.png", "modulus.svg", "report.html",
    *(f"{name}.{ending}" for name in ("curves", "sensitivity", "prediction") for ending in ("csv", "parquet")),
)  # fmt: skip
GAP = (
    "diagnosis.json",
    *(f"{name}.csv" for name in ("gap_map", "ranking", "held_out", "trials", "surface", "summary")),
    "report.html",
)
ELBOW = (
    "elbow.json", "truth.json", "report.html",
    *(f"{name}.{ending}" for name in ("bins", "boxes", "intervals", "scale_line", "held_out", "conditions",
                                      "boxes_free", "surfaces",
                                      "comparison") for ending in ("csv", "parquet")),
    *(f"{name}.{ending}" for name in ("forces", "identifiability", "residuals", "conditions", "surfaces",
                                      "comparison_force", "comparison_displacement") for ending in ("png", "svg")),
)  # fmt: skip
ELBOW_DESIGN = (
    "design.json", "design.png", "design.svg", "report.html",
    *(f"{name}.{ending}" for name in ("map", "boundary", "sensitivity", "force") for ending in ("csv", "parquet")),
)  # fmt: skip
ELBOW_POPULATION = (
    "population.json", "population.png", "population.svg", "report.html",
    *(f"{name}.{end}" for name in ("quantiles", "exceedance", "influence", "samples") for end in ("csv", "parquet")),
)  # fmt: skip
TABLES = ("wrench", "uncertainty", "cells", "frames_cells", "segments", "registration", "agreement")
MAT = (
    *(f"{name}.{ending}" for name in TABLES for ending in ("csv", "parquet")),
    "mat.png", "mat.svg", "mat_on_surface.vtp", "report.html",
)  # fmt: skip
ASKED = ("confuse.json", "separability.csv", "detectability.csv", "planted.json", "report.html")
BENCHMARK = ("benchmark.json", "benchmark.md", "cases.csv", "reliability.png", "reliability.svg")
MULTIBODY = (
    "scaled.osim", "scale.json", "ik.mot", "ik.json", "markers.csv", "knees.csv", "id.sto", "id.json", "markers.trc",
    "report.html",
)  # fmt: skip
NAMES = frozenset({
    *AREA, *PRESSURE, *COP, *LOADCELLS, *FIT, *MODULUS, *ELBOW, *ELBOW_DESIGN, *ELBOW_POPULATION, *MAT, *GAP, *ASKED,
    *BENCHMARK, *MULTIBODY, RUN,
})  # fmt: skip
PARAVIEW = "paraview"
PICTURES = re.compile(
    r"(gap_map|ranking|separability|detectability|gap_residuals|before_after_\w+|gap_surface_\w+)\.(png|svg)"
    r"|((locked|free)_\d+|simulated_[^/]+)\.(csv|parquet)"
    r"|still_[a-z_0-9.,−-]+\.png|paraview/(both|fixed|moving)\.pvd|paraview/frames/(fixed|moving)_\d+\.vtp"
)
"""The only files that are ever removed: those that a run writes, and only where its run.json lists them."""


def left_over(out: Path, draft: Path) -> list[Path]:
    """Files of earlier runs of the same command that would stand in `out` beside the results in `draft`.

    Looked at are `out`, the sub-folders that the draft fills again, and those that the earlier run of `out` filled and
    no other run has since; nothing in them but what their run.json lists.
    """
    command = _told(draft).get("command")
    before = _told(out)
    children = [p for p in out.iterdir() if p.is_dir() and not p.is_symlink()] if out.is_dir() else []
    filled = [p for p in children if (draft / p.name).is_dir() or (p.name in _folders(before) and _same(p, before))]
    found = []
    for place in (out, *filled):
        told = _told(place)
        if told and told.get("command") == command:
            again = draft / place.relative_to(out)
            found += [place / name for name in _files(told) if (place / name).is_file() and not (again / name).exists()]
    return found


def _told(folder: Path) -> dict[str, object]:
    """Content of the folder's run.json; empty when there is none that can be read."""
    try:
        content = json.loads((folder / RUN).read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


def _files(told: dict[str, object]) -> list[str]:
    listed = told.get("files")
    if not isinstance(listed, list):
        return []
    return [name for name in listed if isinstance(name, str) and (name in NAMES or PICTURES.fullmatch(name))]


def _folders(told: dict[str, object]) -> list[object]:
    inputs = told.get("inputs")
    return [entry.get("folder") for entry in inputs if isinstance(entry, dict)] if isinstance(inputs, list) else []


def _same(folder: Path, before: dict[str, object]) -> bool:
    """Whether the results in a sub-folder are those of the run that `before` tells of."""
    told = _told(folder)
    runs = [_results(each).get("run") for each in (told, before)]
    if isinstance(runs[0], str) and runs[0] == runs[1]:
        return True
    return bool(told) and {**told, "files": None} == {**before, "files": None}


def _results(told: dict[str, object]) -> dict[str, object]:
    results = told.get("results")
    return results if isinstance(results, dict) else {}
