"""`geocontact mat --dead`: dead cells told, left out or filled. All recordings here are synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.cli.calls import MESHES, Call, call, done, written
from tests.cli.test_mat import LAYOUT, STILL, mat, table, uniform

GIVEN = MESHES / "mat_thigh_16x8"


def thigh(folder: Path, *options: object, kind: str = "faulty", layout: Path = GIVEN / "layout.toml") -> Call:
    """The shipped recording with offsets, drift and two dead cells, under 79 N."""
    return done(call(
        "mat", GIVEN / f"frames_{kind}.csv", "--layout", layout, "--surface", MESHES / "thigh.stl", "--unit", "mm",
        "--landmarks", GIVEN / "landmarks.csv", "--out", folder / "out", *STILL, *options, folder=folder / "out",
    ))  # fmt: skip


def zeroed(folder: Path, cells: list[list[int]]) -> Path:
    """The shipped clean recording with some cells that read 0."""
    frames = pd.read_csv(GIVEN / "frames.csv", comment="#")
    for row, column in cells:
        frames.iloc[:, 1 + 8 * row + column] = 0.0
    frames.to_csv(folder / "zeroed.csv", index=False)
    return folder / "zeroed.csv"


def told(result: Call) -> dict[str, object]:
    return result.record()["results"]["dead_cells"]


def test_dead_cells_are_told_and_used_as_they_read_unless_asked_for(tmp_path: Path) -> None:
    result = thigh(tmp_path, "--unloaded", "0:0.3,2.8:3")
    (line,) = (each for each in result.warnings if "seem dead" in each)
    assert "row 5 column 3 (0 kPa), row 9 column 6 (0 kPa); used as they read; --dead mask" in line
    cells = told(result)["cells"]
    assert [(c["row"], c["column"], c["known_by"], c["reads_kPa"], c["filled"]) for c in cells] == [
        (5, 3, "its readings", 0.0, False), (9, 6, "its readings", 0.0, False),
    ]  # fmt: skip
    assert told(result)["way"] == "warn" and told(result)["area_left_out_mm2"] == 0.0
    assert len(table(result, "cells.csv")) == 128


def test_masked_cells_are_left_out_and_their_area_is_told(tmp_path: Path) -> None:
    result = thigh(tmp_path, "--dead", "mask")
    (line,) = (each for each in result.warnings if "seem dead" in each)
    assert line.endswith("left out, 400 of 25600 mm²")
    assert told(result)["area_left_out_mm2"] == pytest.approx(400.0)
    cells = table(result, "cells.csv")
    assert len(cells) == 126 and not ((cells["row"] == 5) & (cells["column"] == 3)).any()


@pytest.mark.parametrize("listed", [False, True])
def test_filled_cells_carry_what_their_neighbours_say(tmp_path: Path, listed: bool) -> None:
    """Two dead cells in the middle of the load: the force comes back within what is stated, found or declared."""
    cells = [[5, 3], [7, 4]]
    frames = zeroed(tmp_path, cells)
    layout = GIVEN / "layout.toml"
    if listed:
        layout = written(tmp_path / "listed.toml", layout.read_text() + f"dead = {cells}\n")
    runs = {}
    for way in ("mask", "fill"):
        out = tmp_path / way
        runs[way] = done(call(
            "mat", frames, "--layout", layout, "--surface", MESHES / "thigh.stl", "--unit", "mm", "--landmarks",
            GIVEN / "landmarks.csv", "--dead", way, "--out", out, *STILL, folder=out,
        ))  # fmt: skip
    truth = pd.read_csv(GIVEN / "truth.csv", comment="#", skipinitialspace=True)["normal [N]"]
    k = int(truth.argmax())
    lost, back = (abs(table(runs[way])["normal [N]"][k] - truth[k]) for way in ("mask", "fill"))
    found = told(runs["fill"])
    assert lost > 1.0 and back < 0.2 * lost
    assert [c["filled"] for c in found["cells"]] == [True, True]
    assert {c["known_by"] for c in found["cells"]} == {"the layout" if listed else "its readings"}
    assert found["force_by_filling_N"] == pytest.approx(lost, abs=back + 0.2)
    sd = [table(runs[way], "uncertainty.csv").iloc[k] for way in ("mask", "fill")]
    assert sd[1]["sd_fz [N]"] > sd[0]["sd_fz [N]"]
    assert len(table(runs["fill"], "cells.csv")) == 128
    assert ("seem dead" in runs["fill"].err) != listed


def test_the_uncertainty_contains_what_filling_guesses(tmp_path: Path) -> None:
    """Nothing else is uncertain here: the variance of the filled force is that of the one hole."""
    pressure = uniform(30, 10.0) * np.sin(np.linspace(0.0, np.pi, 30))[:, None, None]
    pressure *= 1.0 + 0.3 * (np.arange(12).reshape(4, 3) % 2)
    pressure[:, 2, 1] = 0.0
    result = done(mat(tmp_path, pressure, *STILL, "--dead", "fill", "--accuracy", "0.0001%"))
    (share,) = told(result)["filling_is_off_by_share"]
    assert share > 0.1
    filled = table(result, "frames_cells.csv")["c7 [Pa]"]
    np.testing.assert_allclose(filled, 1e3 * (pressure[:, [1, 3, 2, 2], [1, 1, 0, 2]]).mean(axis=1), rtol=1e-9)
    sd = table(result, "uncertainty.csv")["sd_fz [N]"]
    np.testing.assert_allclose(sd, share * filled * 1e-4, rtol=1e-3, atol=1e-9)


def test_a_hole_without_a_working_neighbour_is_left_out_and_told(tmp_path: Path) -> None:
    layout = LAYOUT + "dead = [[0, 0]]\nmasked = [[0, 1], [1, 0]]\n"
    result = done(mat(tmp_path, uniform(), *STILL, "--dead", "fill", layout=layout))
    assert "1 dead cells have no working cell beside them" in result.err
    assert table(result)["normal [N]"].iloc[0] == pytest.approx(9.0)


def test_cells_that_clip_are_counted_frame_by_frame(tmp_path: Path) -> None:
    """A cell stuck at the level counts where it is used, and not where it is left out."""
    pressure = uniform(30, 10.0) * np.sin(np.linspace(0.0, np.pi, 30))[:, None, None]
    pressure[:, 2, 1] = 40.0
    pressure[14:16, 0] = 40.0
    layout = LAYOUT + "saturation_kPa = 40\n"
    expected = np.zeros(30)
    expected[14:16] = 3
    for way, more in (("warn", 1), ("mask", 0), ("fill", 0)):
        result = done(mat(tmp_path / way, pressure, *STILL, "--dead", way, layout=layout))
        np.testing.assert_array_equal(table(result)["saturated [-]"], expected + more)


def test_a_sound_recording_says_nothing_of_dead_cells(tmp_path: Path) -> None:
    result = thigh(tmp_path, "--dead", "fill", kind="quantised")
    assert result.warnings == [] and "dead_cells" not in result.record()["results"]


def test_other_ways_are_refused(tmp_path: Path) -> None:
    result = mat(tmp_path, uniform(), "--dead", "bury")
    assert result.code == 2 and "bury" in result.err and not result.folder.exists()


@pytest.mark.parametrize(("touched", "count"), [("1kPa", 1), ("30kPa", 0)])
def test_cells_are_dead_beside_what_counts_as_touched(tmp_path: Path, touched: str, count: int) -> None:
    """Around this cell no more than 29 kPa are read: where less than 30 kPa is no touch, nothing shows it."""
    result = done(call(
        "mat", zeroed(tmp_path, [[5, 3]]), "--layout", GIVEN / "layout.toml", "--surface", MESHES / "thigh.stl",
        "--unit", "mm", "--landmarks", GIVEN / "landmarks.csv", "--touched", touched, "--out", tmp_path / "out", *STILL,
        folder=tmp_path / "out",
    ))  # fmt: skip
    assert len([line for line in result.warnings if "dead" in line]) == count
