"""Dead cells: found where they are, not where there are none, filled no worse than is said. Synthetic recordings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import binary_erosion

from geocontact.data.pressure_frames import PressureFrames
from geocontact.io.mats.catalogue import read_mat
from geocontact.io.mats.layout import read_layout
from geocontact.loads.dead_cells import UNKNOWN, dead_cells, filled, filling_covariance, holes
from geocontact.loads.mat_load import mat_load
from geocontact.loads.mat_map import MatMap
from tests.loads.test_mat import cylinder_map

MESHES = Path(__file__).parents[2] / "meshes"
SHIPPED = ("mat_thigh_16x8", "mat_torso_32x8")
ROWS, COLUMNS = 14, 10
PITCH = (0.010, 0.014)


def shipped(folder: str, kind: str) -> PressureFrames:
    """A shipped recording as if its layout named no dead cell."""
    layout = read_layout(MESHES / folder / "layout.toml")
    (mat,) = read_mat(MESHES / folder / f"{kind}.csv", layout)
    return mat


def test_a_recording_says_in_one_line_what_it_holds() -> None:
    said = repr(mat_of(np.full((3, 2, 2), 1e4)))
    assert said.startswith("<PressureFrames ") and "3 frames" in said and "4 of 2 x 2 cells" in said
    assert said.endswith(f"up to {4e4 * np.prod(PITCH):.0f} N>")


def listed(folder: str) -> list[list[int]]:
    return sorted([r, c] for r, c in read_layout(MESHES / folder / "layout_faulty.toml").dead)


def mat_of(pressure: np.ndarray, valid: np.ndarray | None = None) -> PressureFrames:
    """From frames × rows × columns in Pa."""
    there = np.ones(pressure.shape[1:], bool) if valid is None else valid
    time = 0.02 * np.arange(len(pressure))
    return PressureFrames(
        time, np.where(there, pressure, np.nan), PITCH, there, np.full(there.shape, PITCH[0] * PITCH[1])
    )


def bump(row: float, column: float, width: float) -> np.ndarray:
    """A load that comes and goes, on a round patch with a sharp edge, 60 frames [Pa]."""
    r, c = np.mgrid[:ROWS, :COLUMNS]
    over = np.maximum(1.0 - ((r - row) ** 2 + (c - column) ** 2) / width**2, 0.0)
    return 4e4 * np.sin(np.linspace(0.0, np.pi, 60))[:, None, None] * np.sqrt(over)


def found(mat: PressureFrames) -> list[list[int]]:
    return np.argwhere(dead_cells(mat)).tolist()


@pytest.mark.parametrize("folder", SHIPPED)
@pytest.mark.parametrize("kind", ["frames", "frames_quantised"])
def test_no_false_alarm_on_the_shipped_recordings(folder: str, kind: str) -> None:
    assert found(shipped(folder, kind)) == []


@pytest.mark.parametrize("folder", SHIPPED)
def test_the_dead_cells_of_the_faulty_recordings_are_found_without_being_listed(folder: str) -> None:
    assert found(shipped(folder, "frames_faulty")) == listed(folder)


@pytest.mark.parametrize("level", [0.0, 500.0, 9e3, 4e5])
@pytest.mark.parametrize("cells", [[[6, 4]], [[6, 4], [6, 5]], [[5, 4], [6, 5]], [[6, 4], [6, 5], [7, 5]], [[6, 0]]])
def test_cells_that_stand_still_under_a_load_are_found(level: float, cells: list[list[int]]) -> None:
    pressure = bump(6.0, 4.0, 7.0)
    pressure[:, *np.transpose(cells)] = level
    assert found(mat_of(pressure)) == cells


def test_a_cell_that_is_stuck_high_beside_the_load_is_found() -> None:
    pressure = bump(6.0, 3.0, 3.5)
    pressure[:, 12, 8] = 2e4
    assert found(mat_of(pressure)) == [[12, 8]]
    pressure[:, 12, 8] = 2e3  # an offset, perhaps
    assert found(mat_of(pressure)) == []


def test_on_a_mat_with_noise_whatever_stands_still_is_dead() -> None:
    """A corner, and a whole row: without noise neither can be told from a gap."""
    noise = np.random.default_rng(0).normal(600.0, 50.0, (60, ROWS, COLUMNS))
    pressure = bump(6.0, 3.0, 3.5) + noise
    pressure[:, 0, 9] = pressure[:, 11] = 0.0
    assert found(mat_of(pressure)) == [[0, 9], *([11, c] for c in range(COLUMNS))]
    assert found(mat_of(np.round(pressure, -4))) == [], "noise below the last digit"


def beside_the_load(still: bool) -> np.ndarray:
    """All cells give a little under the heaviest load; one at the edge of the patch does not."""
    pressure = bump(6.0, 3.0, 3.5)
    lift = np.maximum(np.sin(np.linspace(0.0, np.pi, 60)) - 0.8, 0.0)[:, None, None]
    pressure = pressure + 2e3 * lift
    pressure[:, 6, 7 if still else 4] = 0.0
    return pressure


def test_a_cell_at_the_edge_of_the_patch_may_stand_still() -> None:
    """Three of its neighbours are pressed, five are not."""
    assert found(mat_of(beside_the_load(still=True))) == []
    assert found(mat_of(beside_the_load(still=False))) == [[6, 4]]


def two_thighs(gap: int) -> np.ndarray:
    pressure = bump(6.0, 2.0, 12.0) + bump(6.0, 7.0, 12.0)
    pressure[:, :, 4 : 4 + gap] = 0.0
    return pressure


def arch() -> np.ndarray:
    pressure = bump(7.0, 5.0, 9.0)
    pressure[:, 5:8, 4:6] = 0.0
    return pressure


def corner() -> np.ndarray:
    pressure = bump(0.0, 0.0, 9.0)
    pressure[:, 0, 0] = 0.0
    return pressure


@pytest.mark.parametrize(
    "pressure",
    [bump(6.0, 4.0, 3.3), bump(0.0, 0.0, 5.5), two_thighs(1), two_thighs(2), arch(), corner(), 0.0 * arch()],
    ids=["patch", "patch at a corner", "narrow gap", "gap", "arch", "corner cell", "nothing"],
)
def test_zeros_beside_a_load_are_no_dead_cells(pressure: np.ndarray) -> None:
    """A cell at a corner of the mat is given up: it has three neighbours."""
    assert found(mat_of(pressure)) == []


def test_a_few_frames_tell_nothing() -> None:
    pressure = bump(6.0, 4.0, 7.0)
    pressure[:, 6, 4] = 0.0
    assert found(mat_of(pressure[28:37])) == []
    assert found(mat_of(pressure[28:38])) == [[6, 4]]


def test_a_hole_in_a_linear_pressure_is_filled_exactly() -> None:
    """With neighbours on all sides, whatever the pitch; three in a row have them too."""
    r, c = np.mgrid[:ROWS, :COLUMNS]
    plane = (3e3 + 200.0 * r + 700.0 * c)[None] * np.linspace(0.5, 1.0, 4)[:, None, None]
    dead = np.zeros((ROWS, COLUMNS), bool)
    dead[[3, 7, 7, 8], [3, 5, 6, 6]] = True
    spoilt = np.where(dead, 0.0, plane)
    gaps = holes(spoilt, np.ones_like(dead), dead, PITCH)
    assert [len(hole.cell) for hole in gaps] == [1, 3]
    np.testing.assert_allclose(filled(spoilt, gaps), plane, rtol=1e-12)
    assert all(hole.weight.sum(axis=1) == pytest.approx(1.0) and (hole.weight >= 0.0).all() for hole in gaps)


def test_nearer_neighbours_pull_more() -> None:
    """By 1 / pitch^2: rows are 10 mm apart, columns 14 mm."""
    pressure = np.zeros((1, 3, 3))
    pressure[0, [0, 2], 1] = 1e3
    dead = np.zeros((3, 3), bool)
    dead[1, 1] = True
    (hole,) = holes(pressure, np.ones((3, 3), bool), dead, PITCH)
    near, far = 1.0 / PITCH[0] ** 2, 1.0 / PITCH[1] ** 2
    assert hole.of(pressure)[0, 0] == pytest.approx(1e3 * near / (near + far))


def test_cells_that_are_not_there_do_not_pull_and_a_hole_without_neighbours_stays() -> None:
    pressure = np.full((2, 4, 4), 5e3)
    works = np.ones((4, 4), bool)
    works[0, 1] = works[1, 0] = False
    dead = np.zeros((4, 4), bool)
    dead[0, 0] = dead[2, 1] = True
    (hole,) = holes(np.where(works, pressure, 0.0), works, dead, PITCH)
    assert hole.cell.tolist() == [[2, 1]]
    np.testing.assert_allclose(hole.of(pressure), 5e3)


@pytest.mark.parametrize("shape", [[[0, 0]], [[0, 0], [0, 1]], [[0, 0], [1, 0]], [[0, 0], [0, 1], [1, 0]]])
def test_the_stated_error_of_filling_is_that_of_holes_made_on_purpose(shape: list[list[int]]) -> None:
    """Holes all over the pressed part of the thigh's recording: their force is off by less than 2 sd in 95 of 100."""
    mat = shipped("mat_thigh_16x8", "frames")
    pressure, k = mat.pressure, int(np.argmax(mat.force))
    pressed = binary_erosion(pressure[k] > 0.1 * pressure[k].max())
    ratio = []
    for at in np.argwhere(pressed):
        cell = at + np.array(shape)
        if (cell >= pressed.shape).any():
            continue
        dead = np.zeros(pressed.shape, bool)
        dead[cell[:, 0], cell[:, 1]] = True
        (hole,) = holes(np.where(dead, 0.0, pressure), mat.valid, dead, mat.pitch)
        guess = hole.of(pressure)[k].sum()
        ratio.append((guess - pressure[k][dead].sum()) / (hole.share * guess))
    assert np.mean(np.abs(ratio) < 2.0) > 0.9
    assert 0.2 < np.sqrt(np.mean(np.square(ratio))) < 1.3


def test_what_filling_guesses_is_in_the_uncertainty() -> None:
    placed: MatMap = cylinder_map(24)
    pressure = np.full((2, len(placed.area)), 8e3)
    pressure[1] *= 0.5
    load = mat_load(placed, pressure, np.array([0.0, 0.0, 0.1]), "cylinder")
    dead = np.zeros((8, 6), bool)
    dead[[3, 3, 6], [2, 3, 1]] = True
    grid = np.zeros((2, 8, 6))
    grid[:, placed.cell[:, 0], placed.cell[:, 1]] = pressure
    pair, single = (replace(hole, share=share) for hole, share in
                    zip(holes(grid, np.ones_like(dead), dead, PITCH), (0.2, 0.5), strict=True))  # fmt: skip
    total = filling_covariance(placed, pressure, load.wrench, (pair, single))
    own = np.concatenate([placed.force, placed.moment - np.cross([0.0, 0.0, 0.1], placed.force)], axis=1)
    a, b, c = (own[(placed.cell == each).all(axis=1)][0] for each in ([3, 2], [3, 3], [6, 1]))
    together, alone = 0.2 * 8e3 * (a + b), 0.5 * 8e3 * c
    np.testing.assert_allclose(total[0], np.outer(together, together) + np.outer(alone, alone), rtol=1e-12)
    np.testing.assert_allclose(total[1], 0.25 * total[0], rtol=1e-12)


def test_where_nothing_else_works_a_filling_may_be_off_by_all_of_it() -> None:
    pressure = np.zeros((1, 2, 2))
    dead = np.array([[True, False], [False, False]])
    (hole,) = holes(pressure, np.ones((2, 2), bool), dead, PITCH)
    assert hole.share == UNKNOWN
