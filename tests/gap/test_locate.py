"""Where the gap lies."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.locate import Cell, Window, shortest
from tests.elsewhere import Elsewhere
from tests.gap.cases import Bump, located

Found = tuple[tuple[Cell, ...], tuple[Window, ...]]


@pytest.fixture(scope="module")
def pushed(elsewhere: Elsewhere) -> Found:
    found: Found = elsewhere(located, Bump(3.0, 4.0, 0.5))
    return found


def test_shortest_window_holds_seventy_per_cent() -> None:
    curve = np.zeros(100)
    curve[40:50] = 1.0
    low, high = shortest(curve)
    assert high - low == pytest.approx(0.07)
    assert low >= 0.40 and high <= 0.50
    assert shortest(np.ones(100)) == (0.0, 0.7)


def test_a_push_is_found_where_it_is(pushed: Found) -> None:
    cells, seen = pushed
    worst = max((cell for cell in cells if cell.axis == "phase"), key=lambda cell: cell.share)
    assert worst.low >= 0.15 and worst.high <= 0.35
    assert seen[0].channel == "force" and seen[0].share == 1.0
    assert seen[0].phase[0] >= 0.15 and seen[0].phase[1] <= 0.40


def test_without_a_gap_no_cell_is_significant(elsewhere: Elsewhere) -> None:
    cells, _ = elsewhere(located, None)
    assert min(cell.p_value for cell in cells) > 0.02


def test_shares_along_an_axis_add_up(pushed: Found) -> None:
    cells, _ = pushed
    for axis in {cell.axis for cell in cells}:
        total = sum(cell.share for cell in cells if cell.axis == axis)
        assert total == pytest.approx(1.0) or total == 0.0
