"""Cells that carry two forces: the regression read forwards gives the forces back, and each side keeps its moment."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.data.cell_regression import CellRegression
from geocontact.loads.loadcells import CELLS, PUBLISHED, cell_forces, compartment_forces

ROWS = (-0.017, 0.013)
force, place = st.floats(0.0, 3000.0), st.floats(-0.03, 0.03)


@given(st.tuples(force, force), st.tuples(place, place))
def test_the_regression_gives_the_forces_back(sides: tuple[float, float], centre: tuple[float, float]) -> None:
    cells = cell_forces(np.array([sides]), np.array([centre]), ROWS, PUBLISHED)
    back = compartment_forces(np.zeros(1), cells)
    np.testing.assert_allclose([back.medial[0], back.lateral[0]], sides, rtol=1e-9, atol=1e-8)


def test_each_sides_cells_balance_about_the_centre_of_its_patch() -> None:
    centre = np.array([[0.002, -0.006]])
    pm, am, al, pl = cell_forces(np.array([[700.0, 300.0]]), centre, ROWS, PUBLISHED)[0]
    assert (pm * ROWS[0] + am * ROWS[1]) / (pm + am) == pytest.approx(centre[0, 0], rel=1e-12)
    assert (pl * ROWS[0] + al * ROWS[1]) / (pl + al) == pytest.approx(centre[0, 1], rel=1e-12)
    assert pm + am + al + pl == pytest.approx(1000.0, rel=1e-12), "weights of a cell add up to 1"


def test_order_of_the_cells_in_the_regression_does_not_matter() -> None:
    order = (2, 0, 3, 1)
    turned = CellRegression(
        "turned",
        "here",
        tuple(PUBLISHED.cells[i] for i in order),
        tuple(PUBLISHED.medial[i] for i in order),
        tuple(PUBLISHED.lateral[i] for i in order),
    )
    given = (np.array([[700.0, 300.0]]), np.array([[0.002, -0.006]]), ROWS)
    np.testing.assert_allclose(cell_forces(*given, turned), cell_forces(*given, PUBLISHED), rtol=1e-13)
    assert PUBLISHED.cells == CELLS
