"""Cells to compartments: the published weights, sums that are kept, and weights that are none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.data.cell_regression import CellRegression
from geocontact.loads.loadcells import PUBLISHED, compartment_forces

force = st.floats(-100.0, 2000.0)


def test_each_cell_is_shared_out_by_its_published_weight() -> None:
    """F_med = 0.9871 AM + 0.9683 PM + 0.0387 AL + 0.0211 PL, one cell at a time."""
    forces = compartment_forces(np.arange(4.0), np.eye(4)[[PUBLISHED.cells.index(c) for c in ("AM", "PM", "AL", "PL")]])
    np.testing.assert_allclose(forces.medial, [0.9871, 0.9683, 0.0387, 0.0211], rtol=1e-15)
    np.testing.assert_allclose(forces.lateral, [0.0129, 0.0317, 0.9613, 0.9789], rtol=1e-12)


@given(st.lists(st.tuples(force, force, force, force), min_size=1, max_size=20))
def test_nothing_is_lost_between_cells_and_compartments(rows: list[tuple[float, ...]]) -> None:
    cells = np.array(rows)
    forces = compartment_forces(np.arange(float(len(rows))), cells)
    np.testing.assert_allclose(forces.total, cells.sum(axis=1), rtol=1e-12, atol=1e-9)
    assert PUBLISHED.shares == pytest.approx(dict.fromkeys(PUBLISHED.cells, 1.0), rel=1e-12)


@given(st.lists(st.tuples(force, force), min_size=1, max_size=5))
def test_another_tray_has_other_weights(rows: list[tuple[float, float]]) -> None:
    own = CellRegression("two", "made up", ("left", "right"), (1.0, 0.25), (0.0, 0.5))
    forces = compartment_forces(np.arange(float(len(rows))), np.array(rows), own)
    np.testing.assert_allclose(forces.medial, [a + 0.25 * b for a, b in rows], atol=1e-9)
    np.testing.assert_allclose(forces.lateral, [0.5 * b for _, b in rows], atol=1e-9)
    assert own.shares == {"left": 1.0, "right": 0.75}


@pytest.mark.parametrize(
    ("cells", "medial", "lateral", "words"),
    [
        ((), (), (), "0 cells"),
        (("a", "b"), (1.0,), (0.0, 1.0), "2 cells, 1 medial and 2 lateral"),
        (("a", "a"), (1.0, 0.0), (0.0, 1.0), "occurs twice"),
        (("a",), (float("nan"),), (1.0,), "finite"),
    ],
)
def test_weights_that_are_none(cells: tuple[str, ...], medial: tuple, lateral: tuple, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        CellRegression("x", "", cells, medial, lateral)
