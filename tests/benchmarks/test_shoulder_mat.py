"""The mat of the synthetic study: its resultant is what the cuff presses with, in size and direction."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from benchmarks.shoulder.mat import lifting_force, readings, with_noise, write_mat
from benchmarks.shoulder.truth import ALONG
from geocontact.shoulder_exoskeleton.device import lucy
from meshes.mat_placement import UPPER_ARM_MAT

COLUMNS = 11
PRESSURE = 2e3
TIME = np.arange(40) / 100.0


def pressed(first: int, last: int) -> np.ndarray:
    """Cells of the armrest of which some columns, from lateral to medial, are pressed evenly all the time."""
    cells = np.zeros((len(TIME), ALONG, COLUMNS))
    cells[:, :, first:last] = PRESSURE
    return cells


def skin_force(pressure: np.ndarray) -> np.ndarray:
    """Of the same readings by the closed-form skin, mean normals of cells of 2 cm²: no mesh, no pipeline."""
    x, weights = np.polynomial.legendre.leggauss(3)
    shape = (UPPER_ARM_MAT.rows, UPPER_ARM_MAT.columns)
    u, v = ((np.arange(n)[:, None] + 0.5 * (x + 1.0)).ravel() for n in shape)
    normals = UPPER_ARM_MAT.segment.normals(UPPER_ARM_MAT.parameters(u, v)).reshape(shape[0], 3, shape[1], 3, 3)
    mean = np.einsum("iajbx,a,b->ijx", normals, 0.5 * weights, 0.5 * weights)
    return -np.einsum("ij,ijx->x", pressure, mean) * UPPER_ARM_MAT.pitch**2 * 1e-6


def test_each_armrest_cell_is_read_once() -> None:
    """Force between two directions is that of the armrest: mean over the mat's middle of p r / R is p, to 1 %."""
    device = lucy()
    found = readings(device, pressed(0, COLUMNS))[0]
    inside = found[6:10, 2:6]  # wholly within the cuff
    points, weights = UPPER_ARM_MAT.cell_points()
    radius = 1e-3 * (np.hypot(points[..., 0], points[..., 2]) @ weights)[6:10, 2:6]
    np.testing.assert_allclose(inside * radius, PRESSURE * device["cuff_radius"], rtol=1e-2)
    covered = (found > 0.0).any(axis=1).sum() * UPPER_ARM_MAT.pitch * 1e-3
    assert device["cuff_length"] < covered < device["cuff_length"] + 3e-2
    assert readings(device, pressed(0, 5))[0][8, :4].max() < 1e-9  # lateral cells are the mat's last columns


@pytest.mark.slow
def test_the_pipeline_finds_the_force(tmp_path: Path) -> None:
    """With noise within 0.1 N of the smooth skin's, and at most 5 % beside what the whole armrest presses up with."""
    device = lucy()
    cells = pressed(0, COLUMNS)
    exact = readings(device, cells)
    write_mat(tmp_path, TIME, with_noise(exact, 1))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        time, force = lifting_force(tmp_path)
    np.testing.assert_allclose(time, TIME, atol=1e-9)
    assert force.mean() == pytest.approx(-skin_force(exact[0])[2], abs=0.1)
    whole = PRESSURE * 2.0 * device["cuff_radius"] * device["cuff_length"]
    assert force.mean() == pytest.approx(whole, rel=5e-2)
