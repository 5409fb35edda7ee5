"""Where the gap lies."""

from __future__ import annotations

import numpy as np
import pytest
from tests.gap.cases import elbow_case

from geocontact.gap.contest import base_contender
from geocontact.gap.locate import gap_map, shortest, windows
from geocontact.gap.problem import problem_of
from geocontact.systems.catalogue import system_of


def test_shortest_window_holds_seventy_per_cent() -> None:
    curve = np.zeros(100)
    curve[40:50] = 1.0
    low, high = shortest(curve)
    assert high - low == pytest.approx(0.07)
    assert 0.40 <= low and high <= 0.50
    assert shortest(np.ones(100)) == (0.0, 0.7)


def located(push: float) -> tuple:
    case = elbow_case(
        seed=6, change=lambda _, time, force: force + push * np.exp(-0.5 * ((time - 4.0) / 0.5) ** 2)
    )
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    cells = gap_map(problem, base)
    return cells, windows(problem, base, None, cells)


def test_a_push_is_found_where_it_is() -> None:
    cells, seen = located(3.0)
    worst = min((cell for cell in cells if cell.axis == "phase"), key=lambda cell: cell.p_value)
    assert worst.p_value < 0.05
    assert 0.15 <= worst.low and worst.high <= 0.35
    assert seen[0].channel == "force" and seen[0].share == 1.0
    assert 0.15 <= seen[0].phase[0] and seen[0].phase[1] <= 0.40


def test_without_a_gap_no_cell_is_significant() -> None:
    cells, _ = located(0.0)
    assert min(cell.p_value for cell in cells) > 0.02


def test_shares_along_an_axis_add_up() -> None:
    cells, _ = located(3.0)
    for axis in {cell.axis for cell in cells}:
        total = sum(cell.share for cell in cells if cell.axis == axis)
        assert total == pytest.approx(1.0) or total == 0.0
