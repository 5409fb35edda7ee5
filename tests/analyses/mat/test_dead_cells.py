"""Dead cells told, left out or filled. All recordings here are synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.mat.result import MatResult
from tests.analyses.mat.samples import LAYOUT, THIGH, flat, shipped, truth, uniform
from tests.cli.calls import written


def zeroed(folder: Path, cells: list[list[int]]) -> Path:
    """A folder with the shipped clean recording in which some cells read 0."""
    table = pd.read_csv(THIGH / "frames.csv", comment="#")
    for row, column in cells:
        table.iloc[:, 1 + 8 * row + column] = 0.0
    table.to_csv(folder / "frames.csv", index=False)
    for name in ("layout.toml", "landmarks.csv"):
        written(folder / name, (THIGH / name).read_bytes())
    return folder


def told(result: MatResult) -> dict[str, object]:
    return result.record.results["dead_cells"]


def of_the_dead(result: MatResult) -> list[str]:
    return [line for line in result.warnings if "seem dead" in line]


def test_dead_cells_are_told_and_used_as_they_read_unless_asked_for() -> None:
    result = shipped(frames="frames_faulty", unloaded=((0.0, 0.3), (2.8, 3.0)))
    (line,) = of_the_dead(result)
    assert "row 5 column 3 (0 kPa), row 9 column 6 (0 kPa); used as they read; `dead` mask" in line
    cells = told(result)["cells"]
    assert [(c["row"], c["column"], c["known_by"], c["reads_kPa"], c["filled"]) for c in cells] == [
        (5, 3, "its readings", 0.0, False),
        (9, 6, "its readings", 0.0, False),
    ]
    assert told(result)["way"] == "warn" and told(result)["area_left_out_mm2"] == 0.0
    assert len(result.table("cells")) == 128


def test_masked_cells_are_left_out_and_their_area_is_told() -> None:
    result = shipped(frames="frames_faulty", dead="mask")
    (line,) = of_the_dead(result)
    assert line.endswith("left out, 400 of 25600 mm²")
    assert told(result)["area_left_out_mm2"] == pytest.approx(400.0)
    cells = result.table("cells")
    assert len(cells) == 126 and not ((cells["row"] == 5) & (cells["column"] == 3)).any()


@pytest.mark.parametrize("listed", [False, True])
def test_filled_cells_carry_what_their_neighbours_say(tmp_path: Path, listed: bool) -> None:
    """Two dead cells in the middle of the load: the force comes back within what is stated, found or declared."""
    cells = [[5, 3], [7, 4]]
    given = zeroed(tmp_path, cells)
    if listed:
        written(given / "layout.toml", (THIGH / "layout.toml").read_text() + f"dead = {cells}\n")
    masked, filled = (shipped(given, dead=way) for way in ("mask", "fill"))
    exactly = truth()["normal [N]"]
    k = int(exactly.argmax())
    lost, back = (abs(result.table()["normal [N]"][k] - exactly[k]) for result in (masked, filled))
    assert lost > 1.0 and back < 0.2 * lost
    assert [c["filled"] for c in told(filled)["cells"]] == [True, True]
    assert {c["known_by"] for c in told(filled)["cells"]} == {"the layout" if listed else "its readings"}
    assert told(filled)["force_by_filling_N"] == pytest.approx(lost, abs=back + 0.2)
    sd = [result.table("uncertainty")["sd_fz [N]"][k] for result in (masked, filled)]
    assert sd[1] > sd[0]
    assert len(filled.table("cells")) == 128
    assert bool(of_the_dead(filled)) != listed


def test_the_uncertainty_contains_what_filling_guesses(tmp_path: Path) -> None:
    """Nothing else is uncertain here: the variance of the filled force is that of the one hole."""
    pressure = uniform(30, 10.0) * np.sin(np.linspace(0.0, np.pi, 30))[:, None, None]
    pressure *= 1.0 + 0.3 * (np.arange(12).reshape(4, 3) % 2)
    pressure[:, 2, 1] = 0.0
    result = flat(tmp_path, pressure, dead="fill", accuracy=1e-6)
    (share,) = told(result)["filling_is_off_by_share"]
    assert share > 0.1
    filled = result.table("frames_cells")["c7 [Pa]"]
    np.testing.assert_allclose(filled, 1e3 * (pressure[:, [1, 3, 2, 2], [1, 1, 0, 2]]).mean(axis=1), rtol=1e-9)
    sd = result.table("uncertainty")["sd_fz [N]"]
    np.testing.assert_allclose(sd, share * filled * 1e-4, rtol=1e-3, atol=1e-9)


def test_a_hole_without_a_working_neighbour_is_left_out_and_told(tmp_path: Path) -> None:
    layout = LAYOUT + "dead = [[0, 0]]\nmasked = [[0, 1], [1, 0]]\n"
    result = flat(tmp_path, uniform(), layout, dead="fill")
    assert any("1 dead cells have no working neighbour" in line for line in result.warnings)
    assert result.table()["normal [N]"].iloc[0] == pytest.approx(9.0)


@pytest.mark.parametrize(("way", "more"), [("warn", 1), ("mask", 0), ("fill", 0)])
def test_cells_that_clip_are_counted_frame_by_frame(tmp_path: Path, way: str, more: int) -> None:
    """A cell stuck at the level counts where it is used, and not where it is left out."""
    pressure = uniform(30, 10.0) * np.sin(np.linspace(0.0, np.pi, 30))[:, None, None]
    pressure[:, 2, 1] = 40.0
    pressure[14:16, 0] = 40.0
    expected = np.zeros(30)
    expected[14:16] = 3
    result = flat(tmp_path, pressure, LAYOUT + "saturation_kPa = 40\n", dead=way)
    np.testing.assert_array_equal(result.table()["saturated [-]"], expected + more)


def test_a_sound_recording_says_nothing_of_dead_cells() -> None:
    result = shipped(frames="frames_quantised", dead="fill")
    assert result.warnings == () and "dead_cells" not in result.record.results


@pytest.mark.parametrize(("touched", "count"), [(1e3, 1), (30e3, 0)])
def test_cells_are_dead_beside_what_counts_as_touched(tmp_path: Path, touched: float, count: int) -> None:
    """Around this cell no more than 29 kPa are read: where less than 30 kPa is no touch, nothing shows it."""
    result = shipped(zeroed(tmp_path, [[5, 3]]), touched=touched)
    assert len([line for line in result.warnings if "dead" in line]) == count
