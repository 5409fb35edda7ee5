"""The closest-point projection beside the drape. All recordings here are synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.io.recordings.mat_results import read_mat_result
from tests.cli.calls import MESHES, Call, call, done, written
from tests.cli.test_mat import LAYOUT, STILL, frames, mat, scan, table, uniform

GIVEN = MESHES / "mat_thigh_16x8"


def thigh(folder: Path, *options: object) -> Call:
    out = folder / "_".join(["out", *(str(each).strip("-") for each in options)])
    return done(call(
        "mat", GIVEN / "frames.csv", "--layout", GIVEN / "layout.toml", "--surface", MESHES / "thigh.stl", "--unit",
        "mm", "--landmarks", GIVEN / "landmarks.csv", "--out", out, *STILL, *options, folder=out,
    ))  # fmt: skip


def test_it_says_what_the_other_way_of_laying_gives(tmp_path: Path) -> None:
    """Differences are those between two runs of the command, one laid each way."""
    draped, flat = thigh(tmp_path), thigh(tmp_path, "--lay", "closest")
    told = draped.record()["results"]["closest_point_projection"]
    assert "closest_point_projection" not in flat.record()["results"]
    ours, theirs = table(draped), table(flat)
    k = int(ours["normal [N]"].argmax())
    force = np.linalg.norm(ours[[f"f{a} [N]" for a in "xyz"]] - theirs[[f"f{a} [N]" for a in "xyz"]], axis=1)
    assert told["force_differs_N"] == pytest.approx(force[k], rel=1e-6)
    assert told["force_differs_at_most_N"] == pytest.approx(force.max(), rel=1e-6) and force[k] > 1.0
    names = [f"cop_{a} [mm]" for a in "xyz"]
    centre = np.linalg.norm(ours[names] - theirs[names], axis=1)
    assert told["centre_of_pressure_differs_mm"] == pytest.approx(centre[k], rel=1e-6)
    assert told["centre_of_pressure_differs_at_most_mm"] == pytest.approx(np.nanmax(centre), rel=1e-6)
    laid = flat.record()["results"]["mat"]
    assert told["area_distortion_largest"] == pytest.approx(laid["area_distortion_largest"], rel=1e-9)
    assert told["area_distortion_rms"] == pytest.approx(laid["area_distortion_rms"], rel=1e-9)
    assert told["area_distortion_largest"] > 10.0 * draped.record()["results"]["mat"]["area_distortion_largest"]
    cells = table(draped, "cells.csv")
    np.testing.assert_allclose(cells["distortion_projected [-]"], table(flat, "cells.csv")["distortion [-]"])
    assert "distortion_projected [-]" not in table(flat, "cells.csv").columns
    page = (draped.folder / "report.html").read_text(encoding="utf-8")
    assert "Laid along the surface, and pushed straight down" in page
    assert f"{theirs['cop_x [mm]'][k]:.1f}" in page


def test_on_a_plane_both_ways_are_one(tmp_path: Path) -> None:
    told = done(mat(tmp_path, uniform(), *STILL)).record()["results"]["closest_point_projection"]
    assert told["force_differs_at_most_N"] == pytest.approx(0.0, abs=1e-9)
    assert told["centre_of_pressure_differs_at_most_mm"] == pytest.approx(0.0, abs=1e-6)
    assert told["area_distortion_largest"] == pytest.approx(0.0, abs=1e-9) and told["uncovered_cells"] == 0


def test_nothing_pressed_has_no_centre_to_compare(tmp_path: Path) -> None:
    told = done(mat(tmp_path, uniform(40, 0.0), *STILL)).record()["results"]["closest_point_projection"]
    assert told["centre_of_pressure_differs_mm"] is None and told["centre_of_pressure_differs_at_most_mm"] is None
    assert told["force_differs_N"] == 0.0


def waves(x: np.ndarray) -> np.ndarray:
    """Folds of skin, 6 mm up and down every 40 mm [mm]."""
    return 6.0 * np.sin(2.0 * np.pi * x / 40.0)


def test_cells_that_a_flat_mat_leaves_beside_the_scan(tmp_path: Path) -> None:
    """On 112 mm of folded skin a mat of 120 mm lies when it follows the folds; flat, it ends beside the scan."""
    x, y = np.linspace(-2.0, 110.0, 113), np.arange(0.0, 61.0, 6.0)
    lines = [f"v {a} {b} {waves(a):.9g}" for a in x for b in y]
    for k in (len(y) * i + j + 1 for i in range(len(x) - 1) for j in range(len(y) - 1)):
        lines += [f"f {k} {k + len(y)} {k + len(y) + 1}", f"f {k} {k + len(y) + 1} {k + 1}"]
    fine = np.linspace(0.0, 40.0, 4001)
    period = float(np.hypot(np.diff(fine), np.diff(waves(fine))).sum()) / 10.0  # in rows
    rows = [f"m{r}{c},{r * period:.6f},{c},{40 * r},{10 + 10 * c},0" for r in (0, 1, 2) for c in (0, 3)]
    marks = written(tmp_path / "marks.csv", "\n".join(["id, row, column, x [mm], y [mm], z [mm]", *rows]) + "\n")
    names = [f"r{r}c{c}" for r in range(12) for c in range(3)]
    readings = [",".join(["time [s]", *names]), *(",".join([f"{0.02 * k:g}", *["10"] * 36]) for k in range(20))]
    result = done(call(
        "mat", written(tmp_path / "frames.csv", "\n".join(readings) + "\n"), "--layout",
        written(tmp_path / "layout.toml", 'rows = 12\ncolumns = 3\npitch_mm = 10\nunit = "kPa"\n'), "--surface",
        written(tmp_path / "folds.obj", "\n".join(lines) + "\n"), "--unit", "mm", "--landmarks", marks, "--out",
        tmp_path / "out", *STILL, folder=tmp_path / "out",
    ))  # fmt: skip
    told = result.record()["results"]["closest_point_projection"]
    cells = table(result, "cells.csv")
    lost = cells["distortion_projected [-]"] == -1.0
    assert len(cells) == 36 and cells.notna().all(axis=None)
    assert told["uncovered_cells"] == lost.sum() and set(cells.loc[lost, "row"]) == {0, 11}
    assert read_mat_result(tmp_path / "out").pressure.shape == (20, 36), "gap cases are made of this table"


def test_two_landmarks_place_no_flat_mat_and_that_is_told(tmp_path: Path) -> None:
    two = written(tmp_path / "two.csv", "id, row, column, x [mm], y [mm], z [mm]\na,0,0,20,30,0\nb,4,3,60,60,0\n")
    result = done(call(
        "mat", frames(tmp_path, uniform()), "--layout", written(tmp_path / "layout.toml", LAYOUT), "--surface",
        scan(tmp_path), "--unit", "mm", "--landmarks", two, "--out", tmp_path / "out", *STILL, folder=tmp_path / "out",
    ))  # fmt: skip
    told = result.record()["results"]["closest_point_projection"]
    assert list(told) == ["not_possible"] and "landmark" in told["not_possible"]
    assert "distortion_projected [-]" not in table(result, "cells.csv").columns
