"""Figures of docs/reference/paper_004.md come out again: fits, areas, E* at R = 37 mm, load cells.

The page says what the benchmark found. Its predictions and the fits with more free are told by the benchmark alone.
"""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

from benchmarks.knee import paper_004
from geocontact.data.errors import InputWarning
from geocontact.io.mesh.meshes import read_mesh

ROOT = Path(__file__).resolve().parents[2]
FOUND = json.loads((ROOT / "benchmarks" / "results" / "paper_004.json").read_text(encoding="utf-8"))
PAGE = (ROOT / "docs" / "reference" / "paper_004.md").read_text(encoding="utf-8")


def same(ours: object, theirs: object) -> None:
    """Equal to the digits that are kept, whatever the nesting."""
    if isinstance(theirs, dict):
        assert isinstance(ours, dict) and set(ours) == set(theirs)
        for name, value in theirs.items():
            same(ours[name], value)
    elif isinstance(theirs, list):
        assert isinstance(ours, list) and len(ours) == len(theirs)
        for mine, value in zip(ours, theirs, strict=True):
            same(mine, value)
    elif isinstance(theirs, float):
        assert ours == pytest.approx(theirs, rel=2e-3, abs=2e-3)
    else:
        assert ours == theirs


@pytest.mark.parametrize("name", ["all faces", "posterior", "medial condyle, posterior (+z)", "patellar button"])
def test_fits(data_dir: Path, tmp_path: Path, name: str) -> None:
    same(paper_004.fitted(data_dir, tmp_path / "o", *paper_004.FITS[name]), FOUND["fits"][name])


@pytest.mark.slow
def test_areas_and_modulus(data_dir: Path, tmp_path: Path) -> None:
    same(paper_004.areas(data_dir, tmp_path, "coarse"), FOUND["area, workshop's meshes"])
    same(paper_004.profile(data_dir, tmp_path), FOUND["sagittal radius [mm]"])
    for name in ("R = 37 mm", "R of flexion"):
        same(paper_004.modulus(data_dir, tmp_path, name), FOUND["modulus"][name])


@pytest.mark.slow
def test_areas_of_the_original_meshes(data_dir: Path, tmp_path: Path) -> None:
    noted = {name: FOUND["area, original meshes"][name] for name in ("signed", "0.5", "4")}
    same(paper_004.areas(data_dir, tmp_path, "fine", (0.5, 4.0)), noted)


def test_load_cells_have_no_convention_that_gives_1076_and_597(data_dir: Path, tmp_path: Path) -> None:
    found = paper_004.load_cells(data_dir, tmp_path)
    same(found, FOUND["load cells"])
    tried = np.array(list(found["other conventions, medial and lateral [N]"].values()))
    assert len(tried) == 27
    assert (np.abs(tried - [1076.0, 597.0]).max(axis=1) > 30.0).all()


FEMURS = ["gc4_jw_knee/stl/Femoral Component.stl", "gc6_dm_knee/stl/Femoral Component decimated.stl"]


@pytest.mark.parametrize("mesh", FEMURS)
def test_flange_lies_at_minus_x_and_its_groove_runs_to_minus_z(data_dir: Path, mesh: str) -> None:
    """x is posterior in files that are described as having it anterior; in a right knee medial is then +z."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # doubled faces of one of them
        points = read_mesh(data_dir / mesh, "m").vertices * 1e3
    assert points[points[:, 1] > 10.0][:, 0].max() < 0.0, "only the flange reaches this high"
    above, below = (groove(points, low, high) for low, high in ((8.0, 18.0), (-22.0, -14.0)))
    assert above < below - 1.0


def groove(points: np.ndarray, low: float, high: float) -> float:
    """z of the deepest line of the flange's front between two heights [mm]."""
    front = points[(points[:, 1] > low) & (points[:, 1] < high) & (points[:, 0] < 0.0) & (np.abs(points[:, 2]) < 13.0)]
    places = np.arange(-12.0, 12.1, 1.5)
    depth = [front[np.abs(front[:, 2] - z) < 1.5][:, 0].min() for z in places]
    return float(places[int(np.argmax(depth))])


def test_the_page_says_what_was_found() -> None:
    fits, modulus = FOUND["fits"], FOUND["modulus"]
    for name in ("all faces", "bearing", "bearing, facing down", "distal", "posterior"):
        low, high = fits[name]["radius_ci95_mm"]
        assert f"{fits[name]['radius_mm']:.2f} ({low:.2f} … {high:.2f})" in PAGE
    for name, rows in modulus.items():
        for side in ("total", "medial", "lateral"):
            value = f"{rows['E* [MPa]'][side]:.2f}"
            if rows["R2"]["total"] < 0.0:  # the law contradicts the forces: a number without an interval
                assert side not in rows["95 % [MPa]"] and f"| {value} |" in PAGE, (name, side)
                continue
            low, high = rows["95 % [MPa]"][side]
            assert f"{value} ({low:.2f} … {high:.{2 if high < 10 else 1}f})" in PAGE, (name, side)
    for name in ("area, workshop's meshes", "area, original meshes"):
        for level in paper_004.THRESHOLDS:
            low, high = FOUND[name][f"{level:g}"]
            assert f"{low:.0f}–{high:.0f}" in PAGE, (name, level)
    peaks = FOUND["load cells"]["peaks [N]"]
    assert all(f"{peaks[side]:.1f}" in PAGE for side in ("medial", "lateral", "total"))
