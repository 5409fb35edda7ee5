"""The closest-point projection beside the drape. All recordings here are synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.mat.show import mat_page
from geocontact.io.recordings.mat_results import read_mat_result
from tests.analyses.mat.samples import CENTRE, FORCE, called, flat, frames, shipped, uniform, unpictured
from tests.cli.calls import written

HERE = "closest_point_projection"


def test_it_says_what_the_other_way_of_laying_gives() -> None:
    """Differences are those between two results, one laid each way."""
    draped, projected = shipped(), shipped(lay="closest")
    told = draped.record.results[HERE]
    assert HERE not in projected.record.results and projected.closest_point is None
    ours, theirs = draped.table(), projected.table()
    k = int(ours["normal [N]"].argmax())
    force = np.linalg.norm(ours[FORCE] - theirs[FORCE], axis=1)
    assert told["force_differs_N"] == pytest.approx(force[k], rel=1e-6)
    assert told["force_differs_at_most_N"] == pytest.approx(force.max(), rel=1e-6) and force[k] > 1.0
    centre = np.linalg.norm(ours[CENTRE] - theirs[CENTRE], axis=1)
    assert told["centre_of_pressure_differs_mm"] == pytest.approx(centre[k], rel=1e-6)
    assert told["centre_of_pressure_differs_at_most_mm"] == pytest.approx(np.nanmax(centre), rel=1e-6)
    laid = projected.record.results["mat"]
    assert told["area_distortion_largest"] == pytest.approx(laid["area_distortion_largest"], rel=1e-9)
    assert told["area_distortion_rms"] == pytest.approx(laid["area_distortion_rms"], rel=1e-9)
    assert told["area_distortion_largest"] > 10.0 * draped.record.results["mat"]["area_distortion_largest"]
    cells = draped.table("cells")
    np.testing.assert_allclose(cells["distortion_projected [-]"], projected.table("cells")["distortion [-]"])
    assert "distortion_projected [-]" not in projected.table("cells").columns
    sections = mat_page(draped, np.array([k]), b"<svg/>").sections
    (table,) = (each for each in sections if "pushed straight down" in getattr(each, "title", ""))
    assert f"{theirs['cop_x [mm]'][k]:.1f}" in {row[2] for row in table.rows}


def test_on_a_plane_both_ways_are_one(tmp_path: Path) -> None:
    told = flat(tmp_path, uniform()).record.results[HERE]
    assert told["force_differs_at_most_N"] == pytest.approx(0.0, abs=1e-9)
    assert told["centre_of_pressure_differs_at_most_mm"] == pytest.approx(0.0, abs=1e-6)
    assert told["area_distortion_largest"] == pytest.approx(0.0, abs=1e-9) and told["uncovered_cells"] == 0


def test_nothing_pressed_has_no_centre_to_compare(tmp_path: Path) -> None:
    told = flat(tmp_path, uniform(40, 0.0)).record.results[HERE]
    assert told["centre_of_pressure_differs_mm"] is None and told["centre_of_pressure_differs_at_most_mm"] is None
    assert told["force_differs_N"] == 0.0


def waves(x: np.ndarray) -> np.ndarray:
    """Folds of skin, 6 mm up and down every 40 mm [mm]."""
    return 6.0 * np.sin(2.0 * np.pi * x / 40.0)


def folds(folder: Path) -> Path:
    """112 mm of folded skin."""
    x, y = np.linspace(-2.0, 110.0, 113), np.arange(0.0, 61.0, 6.0)
    lines = [f"v {a} {b} {waves(a):.9g}" for a in x for b in y]
    for k in (len(y) * i + j + 1 for i in range(len(x) - 1) for j in range(len(y) - 1)):
        lines += [f"f {k} {k + len(y)} {k + len(y) + 1}", f"f {k} {k + len(y) + 1} {k + 1}"]
    return written(folder / "folds.obj", "\n".join(lines) + "\n")


def test_cells_that_a_flat_mat_leaves_beside_the_scan(tmp_path: Path) -> None:
    """On 112 mm of folded skin a mat of 120 mm lies when it follows the folds; flat, it ends beside the scan."""
    fine = np.linspace(0.0, 40.0, 4001)
    period = float(np.hypot(np.diff(fine), np.diff(waves(fine))).sum()) / 10.0  # in rows
    rows = [f"m{r}{c},{r * period:.6f},{c},{40 * r},{10 + 10 * c},0" for r in (0, 1, 2) for c in (0, 3)]
    result = called(
        frames(tmp_path, np.full((20, 12, 3), 10.0)),
        layout=written(tmp_path / "layout.toml", 'rows = 12\ncolumns = 3\npitch_mm = 10\nunit = "kPa"\n'),
        surface=folds(tmp_path),
        landmarks=written(tmp_path / "marks.csv", "\n".join(["id, row, column, x [mm], y [mm], z [mm]", *rows]) + "\n"),
    )
    cells = result.table("cells")
    lost = cells["distortion_projected [-]"] == -1.0
    assert len(cells) == 36 and cells.notna().all(axis=None)
    assert result.record.results[HERE]["uncovered_cells"] == lost.sum() and set(cells.loc[lost, "row"]) == {0, 11}
    with unpictured():
        folder = result.write(tmp_path / "out")
    assert read_mat_result(folder).pressure.shape == (20, 36), "gap cases are made of this table"


def test_two_landmarks_place_no_flat_mat_and_that_is_told(tmp_path: Path) -> None:
    two = written(tmp_path / "two.csv", "id, row, column, x [mm], y [mm], z [mm]\na,0,0,20,30,0\nb,4,3,60,60,0\n")
    result = flat(tmp_path, uniform(), landmarks=two)
    told = result.record.results[HERE]
    assert list(told) == ["not_possible"] and "landmark" in told["not_possible"]
    assert "distortion_projected [-]" not in result.table("cells").columns
