"""Shear of a two-axis mat: closed form on a plane, by hand from the written cells on a thigh, the friction limit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.mat.result import MatResult
from geocontact.analyses.mat.shear import same_times
from geocontact.data.errors import InputError
from tests.analyses.mat.samples import COLS, FORCE, MOMENT, PITCH, ROWS, THIGH, flat, frames, shipped
from tests.analyses.mat.test_motion import pose, poses

AREA = (1e-3 * PITCH) ** 2


def stress(folder: Path, name: str, values: np.ndarray) -> Path:
    (folder / name).mkdir(parents=True)
    return frames(folder / name, values)


def sheared(folder: Path, pressure: np.ndarray, rows: np.ndarray, columns: np.ndarray, **options: object) -> MatResult:
    files = {"shear_rows": stress(folder, "rows", rows), "shear_columns": stress(folder, "columns", columns)}
    return flat(folder, pressure, **files, **options)


def test_uniform_shear_on_a_plane_is_stress_times_area(tmp_path: Path) -> None:
    """Twelve cells of 1 cm²: 3 and -2 kPa; the moment is that of the force at the mat's middle; of either sign."""
    shape = (3, ROWS, COLS)
    found = sheared(tmp_path, np.full(shape, 10.0), np.full(shape, 3.0), np.full(shape, -2.0))
    cells = found.tables()["cells"].set_index(["row", "column"])
    place = cells[["x [m]", "y [m]", "z [m]"]]
    down, right = ((place.loc[at] - place.loc[(0, 0)]).to_numpy() / (1e-3 * PITCH) for at in ((1, 0), (0, 1)))
    force = 12 * AREA * 1e3 * (3.0 * down - 2.0 * right)
    table = found.tables()["shear"]
    np.testing.assert_allclose(table[FORCE], np.tile(force, (3, 1)), atol=1e-9)
    np.testing.assert_allclose(table[MOMENT], np.tile(np.cross(place.mean().to_numpy(), force), (3, 1)), atol=1e-9)
    assert table["shear [N]"].tolist() == pytest.approx([12 * AREA * 1e3 * np.hypot(3.0, 2.0)] * 3)
    assert table["shear over normal [-]"].tolist() == pytest.approx([np.hypot(0.3, 0.2)] * 3)
    assert found.shear is not None
    assert found.shear.cells_beyond == 0.0
    assert not [each for each in found.warnings if "shear" in each]


def test_shear_beyond_friction_is_named(tmp_path: Path) -> None:
    """Sixty frames, half of them with twice the pressure in shear."""
    shape = (60, ROWS, COLS)
    rows = np.full(shape, 2.0)
    rows[30:] = 20.0
    found = sheared(tmp_path, np.full(shape, 10.0), rows, np.zeros(shape), friction=0.5)
    assert found.shear is not None
    assert (found.shear.limit.beyond, found.shear.cells_beyond) == (pytest.approx(0.5), pytest.approx(0.5))
    assert any("shear exceeds friction 0.5 times the normal force for 50% of the time" in w for w in found.warnings)


def test_noise_adds_up_to_no_shear(tmp_path: Path) -> None:
    """Half of the cells carry 10 kPa, noise of 1 kPa in every cell: lengths over all cells would be 1.5 N."""
    shape = (300, ROWS, COLS)
    pressure = np.full(shape, 10.0)
    pressure[:, ROWS // 2 :] = 0.0
    rng = np.random.default_rng(6)
    rows, columns = rng.normal(0.0, 1.0, (2, *shape))
    found = sheared(tmp_path, pressure, rows, columns, friction=0.05)
    loaded = ROWS // 2 * COLS
    spread = AREA * 1e3 * np.sqrt(loaded)
    table = found.tables()["shear"]
    assert table["shear [N]"].mean() == pytest.approx(spread * np.sqrt(np.pi / 2.0), rel=0.1), "Rayleigh"
    size = AREA * 1e3 * np.hypot(rows, columns)[:, : ROWS // 2].sum(axis=(1, 2))
    assert np.mean(size > 0.05 * table["normal [N]"]) > 0.9, "lengths of the noise exceed the limit"
    assert found.shear is not None
    assert found.shear.limit.noise == pytest.approx(np.sqrt(2.0) * spread, rel=0.2)
    assert found.shear.limit.kept
    assert not [each for each in found.warnings if "shear" in each]


def test_an_unloaded_mat_has_no_shear(tmp_path: Path) -> None:
    """Loaded from the hundredth frame on; the warning says that its friction is the default."""
    shape = (200, ROWS, COLS)
    pressure = np.zeros(shape)
    pressure[100:] = 10.0
    rows = np.random.default_rng(7).normal(0.0, 1.0, shape)
    rows[150:] += 20.0
    found = sheared(tmp_path, pressure, rows, np.zeros(shape))
    assert (found.tables()["shear"]["shear [N]"][:100] == 0.0).all()
    assert found.shear is not None
    assert found.shear.limit.beyond == pytest.approx(0.25)
    assert any("friction 1 (the default: state `friction`) times the normal force for 25%" in w for w in found.warnings)


def test_frames_are_found_in_long_recordings() -> None:
    """By a search in order: all pairs of 200 000 frames would need 320 GB."""
    recorded = np.arange(200_000) * 0.01
    wanted = recorded[500:180_000:3] + 4e-7
    np.testing.assert_array_equal(same_times(recorded, wanted), np.arange(500, 180_000, 3))
    assert same_times(recorded[:3], np.array([0.01])).tolist() == [1]


def test_on_a_thigh_it_is_the_sum_over_the_written_cells(tmp_path: Path) -> None:
    """Directions by the centres of neighbouring cells instead of the corners; the shear is a share of the pressure."""
    table = pd.read_csv(THIGH / "frames.csv", comment="#").astype(float)
    files = {}
    for option, share in (("shear_rows", 0.3), ("shear_columns", -0.1)):
        own = table.copy()
        own.iloc[:, 1:] *= share
        files[option] = tmp_path / f"{option}.csv"
        own.to_csv(files[option], index=False)
    found = shipped(**files)
    tables = found.tables()
    cells, pressure = tables["cells"], tables["frames_cells"].iloc[:, 1:].to_numpy()
    centre = np.full((16, 8, 3), np.nan)
    normal = np.full((16, 8, 3), np.nan)
    row, column = cells["row"].to_numpy(), cells["column"].to_numpy()
    centre[row, column] = cells[["x [m]", "y [m]", "z [m]"]]
    normal[row, column] = cells[["nx [-]", "ny [-]", "nz [-]"]]
    units = []
    for axis in (0, 1):
        along = np.gradient(centre, axis=axis)
        along -= np.sum(along * normal, axis=2, keepdims=True) * normal
        units.append((along / np.linalg.norm(along, axis=2, keepdims=True))[row, column])
    each = cells["area [m^2]"].to_numpy()[:, None] * (0.3 * units[0] - 0.1 * units[1])
    force = pressure @ each
    size = np.abs(force).max()
    assert size > 10.0
    np.testing.assert_allclose(tables["shear"][FORCE], force, atol=0.02 * size)
    moment = pressure @ np.cross(centre[row, column], each)
    np.testing.assert_allclose(tables["shear"][MOMENT], moment, atol=0.02 * np.abs(moment).max())


def test_shear_is_carried_along_with_the_segment(tmp_path: Path) -> None:
    """Half of the frames have a pose; about a point of the other frame."""
    table = pd.read_csv(THIGH / "frames.csv", comment="#").astype(float)
    files = {}
    for option in ("shear_rows", "shear_columns"):
        table.iloc[:, 1:] *= 0.3
        files[option] = tmp_path / f"{option}.csv"
        table.to_csv(files[option], index=False)
    still = shipped(**files).table("shear").set_index("time [s]")
    moving = shipped(**files, point="100,900,-50", motion=poses(tmp_path, 0.5, 1.0, 2.0)).table("shear")
    here = still.loc[moving["time [s]"]]
    x, point = pose(moving["time [s]"].to_numpy()), np.array([0.1, 0.9, -0.05])
    force = x.rotation.apply(here[FORCE].to_numpy())
    np.testing.assert_allclose(moving[FORCE], force, atol=1e-9)
    moment = x.rotation.apply(here[MOMENT].to_numpy()) + np.cross(x.translation - point, force)
    np.testing.assert_allclose(moving[MOMENT], moment, atol=1e-9)


@pytest.mark.parametrize("cut", ["frames", "cells"])
def test_shear_of_another_recording_is_refused(tmp_path: Path, cut: str) -> None:
    shape = (3, ROWS, COLS)
    rows = np.zeros((2, ROWS, COLS) if cut == "frames" else (3, ROWS, COLS - 1))
    with pytest.raises(InputError, match=r"other cells or times|columns are named|cells"):
        sheared(tmp_path, np.full(shape, 10.0), rows, np.zeros(shape))


def test_a_two_axis_mat_has_both(tmp_path: Path) -> None:
    shape = (3, ROWS, COLS)
    one = stress(tmp_path, "rows", np.zeros(shape))
    with pytest.raises(InputError, match="`shear_columns`"):
        flat(tmp_path, np.full(shape, 10.0), shear_rows=one)
    (tmp_path / "tek.csv").write_text("COLS 3\nROWS 4\nFrame 1\n1 2 3\n", encoding="utf-8")
    with pytest.raises(InputError, match="is no plain grid of cells"):
        flat(tmp_path, np.full(shape, 10.0), shear_rows=one, shear_columns=tmp_path / "tek.csv")
