"""A mat around a tube beside the same mat pushed down flat: closed forms of the difference."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.loads.closest_point_mat import ClosestPoint, beside_closest_point
from geocontact.loads.mat_map import mat_map
from tests.geometry.drape.sheets import over, plane, tube

MAT = Mat(3, 6, (0.02, 0.02))
CORNERS = np.array([[0.0, 0], [3, 0], [0, 6], [3, 6]])
RADIUS = 0.06


def frames(*pressures: float) -> PressureFrames:
    """Every cell alike [Pa], one frame each."""
    pressure = np.multiply.outer(np.array(pressures), np.ones((3, 6)))
    cells = np.ones((3, 6), bool)
    return PressureFrames(np.arange(len(pressures)) * 0.1, pressure, MAT.pitch, cells, np.full((3, 6), MAT.cell_area))


def beside(sheet, points: np.ndarray, seen: PressureFrames, gate: float = 0.0) -> ClosestPoint:
    marks = Marks(CORNERS, points)
    laid = lay(sheet, MAT, marks)
    cells = mat_map(sheet.surface, laid.nodes, laid.covered, seen.cell_area)
    return beside_closest_point(sheet.surface, MAT, marks, cells, seen, gate)


def test_on_a_plane_nothing_differs() -> None:
    flat = np.column_stack([MAT.away(CORNERS), np.zeros(4)])
    found = beside(over(plane(0.3)), flat, frames(1e3, 2e3), gate=10.0)
    assert found.frame == 1
    np.testing.assert_allclose(found.force_apart, 0.0, atol=1e-9)
    assert np.isnan(found.centre_apart[0]), "7.2 N of 1 kPa on 72 cm² are below the gate"
    assert found.centre_apart[1] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(found.distortion, 0.0, atol=1e-9)


def test_on_a_tube_the_flat_mat_lies_where_its_corners_are() -> None:
    # a column between the angles a and b pushes with p A (sin b - sin a) / (b - a) along the middle of the mat; laid
    # along the tube it lies between y / R; the flat mat that fits the corners best is the plane at R cos(half) from the
    # axis, and goes out to the tube between atan(y / (R cos half))
    sheet, half = over(tube(RADIUS, height=0.3, n=180)), 0.06 / RADIUS
    points = np.array([[RADIUS * np.cos(s), RADIUS * np.sin(s), z] for z, s in zip(*corner_places(half), strict=True)])
    found = beside(sheet, points, frames(1e3))
    flat_y = np.linspace(-0.06, 0.06, 7)
    angles = (flat_y / RADIUS, np.arctan(flat_y / (RADIUS * np.cos(half))))
    forces = [1e3 * 3 * MAT.cell_area * (np.diff(np.sin(each)) / np.diff(each)).sum() for each in angles]
    assert found.used.pressing[0] == found.projected.pressing[0] == pytest.approx(1e3 * 18 * MAT.cell_area)
    assert np.linalg.norm(found.used.wrench.force[0]) == pytest.approx(forces[0], rel=2e-3)
    assert np.linalg.norm(found.projected.wrench.force[0]) == pytest.approx(forces[1], rel=2e-3)
    assert found.force_apart[0] == pytest.approx(abs(forces[1] - forces[0]), rel=1e-2)


def corner_places(half: float) -> tuple[list[float], list[float]]:
    """Heights [m] and angles [rad] of the corners; rows run up, columns to the left seen from outside."""
    return [0.12, 0.18, 0.12, 0.18], [half, half, -half, -half]


def test_two_marks_do_not_place_a_flat_mat() -> None:
    sheet = over(plane(0.3))
    flat = np.column_stack([MAT.away(CORNERS), np.zeros(4)])
    seen, laid = frames(1e3), lay(sheet, MAT, Marks(CORNERS, flat))
    cells = mat_map(sheet.surface, laid.nodes, laid.covered, seen.cell_area)
    with pytest.raises(ValueError, match="3 landmarks at least"):
        beside_closest_point(sheet.surface, MAT, Marks(CORNERS[:2], flat[:2]), cells, seen)
