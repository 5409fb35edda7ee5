"""Inputs of benchmarks.robustness.growth are as long as is asked, and what the shipped samples are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from benchmarks.robustness import growth
from benchmarks.robustness.growth_inputs import MESHES, WALK, modulus, pairs, prosthesis_simulate, shoulder_simulate


def numbers(file: Path, before: int, between: str) -> np.ndarray:
    """Rows of a file of the samples, which are numbers after so many lines that are not empty."""
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if line.strip()]
    return np.array([[float(each) for each in line.split(between)] for line in lines[before:]])


def test_every_command_has_four_sizes_that_grow() -> None:
    for command, (_, sizes) in growth.COMMANDS.items():
        assert len(sizes) == 4 and all(np.diff(sizes) > 0), command


def test_motions_pass_through_the_sample_forwards_and_backwards(tmp_path: Path) -> None:
    """205 frames of one of 101: there, back again and five more, none of them twice in a row."""
    pairs(tmp_path, 205)
    for name in ("gait.csv", "gait_patella.csv"):
        sample, found = numbers(MESHES / name, 1, ","), numbers(tmp_path / name, 1, ",")
        expected = [*sample[:, 1:], *sample[-2:0:-1, 1:], *sample[:5, 1:]]
        assert np.array_equal(found[:, 1:], np.array(expected))
        assert np.allclose(np.diff(found[:, 0]), 0.01)


@pytest.mark.parametrize("n", [193, 385])
def test_markers_at_a_higher_rate_are_on_lines_between_the_sample_s(tmp_path: Path, n: int) -> None:
    prosthesis_simulate(tmp_path, n)
    sample, found = (numbers(folder / "walking.trc", 5, "\t") for folder in (MESHES / WALK, tmp_path))
    every = (n - 1) // 96
    assert len(found) == n and np.allclose(found[::every, 1:], sample[:, 1:], atol=1e-4)
    assert np.allclose(found[every // 2 :: every, 2:], 0.5 * (sample[1:, 2:] + sample[:-1, 2:]), atol=1e-4)
    rate = float((tmp_path / "walking.trc").read_text(encoding="utf-8").splitlines()[2].split("\t")[0])
    assert rate == pytest.approx(100.0 * every)


def test_markers_of_a_longer_work_do_not_jump(tmp_path: Path) -> None:
    """Nor do they move faster from frame to frame than in the sample."""
    shoulder_simulate(tmp_path, 1700)
    sample = numbers(MESHES / "overhead_P1T1S100" / "markers.trc", 5, "\t")
    found = numbers(tmp_path / "markers.trc", 5, "\t")
    assert len(found) == 1700 and np.allclose(np.diff(found[:, 1]), 0.01)
    assert np.abs(np.diff(found[:, 2:], axis=0)).max() <= np.abs(np.diff(sample[:, 2:], axis=0)).max() + 1e-9


def test_forces_beside_areas_are_those_of_the_law(tmp_path: Path) -> None:
    """A circle of the area at 4 mm, 6.8 MPa and 37 mm; the mean of 20 N of noise over 2000 frames is below 2 N."""
    modulus(tmp_path, 2000)
    area, force = pd.read_csv(tmp_path / "area.csv"), pd.read_csv(tmp_path / "forces.csv")
    at_4mm = area.loc[area["threshold [mm]"] == 4.0, "area_fixed [mm^2]"].to_numpy()
    radius = np.sqrt(at_4mm / np.pi)  # mm
    noise = force["total [N]"].to_numpy() - 4.0 * 6.8 * radius**3 / (3.0 * 37.0)
    assert len(noise) == 2000 and abs(noise.mean()) < 2.0 and noise.std() == pytest.approx(20.0, rel=0.1)
