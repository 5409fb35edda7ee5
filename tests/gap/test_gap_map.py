"""Where the gap lies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.gap_cells import Cell
from geocontact.gap.localise.gap_map import (
    BLOCKS,
    PHASES,
    Window,
    _least,
    _placed,
    energies,
    family_wise,
    in_order,
    load_outputs,
    shortest,
    systematic,
)
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import Bump, Drift, Swing, Unmeasured, elbow_case, located

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


def test_what_swings_inside_a_bin_is_seen_in_the_fast_part_only(elsewhere: Elsewhere) -> None:
    cells, _ = elsewhere(located, Swing(6.4, 7.2, 0.6, 9.0))
    fast = [cell for cell in cells if cell.axis == "fast phase"]
    (loud,) = (cell for cell in fast if cell.p_value <= 0.05)
    assert (loud.low, loud.high) == (0.4, 0.45)
    assert loud.share > 0.6 and loud.ci95[0] > 0.4
    assert min(cell.p_value for cell in cells if cell.axis == "phase") > 0.05


def test_a_drift_is_not_fast(elsewhere: Elsewhere) -> None:
    """It is 13 times the noise in the end, so the trial ends far from where it began."""
    cells, _ = elsewhere(located, Drift(0.1))
    slow, _, fast = (cell for cell in cells if cell.axis == "band")
    assert slow.p_value < 0.01 and fast.p_value > 0.05
    assert min(cell.p_value for cell in cells if cell.axis == "fast phase") > 0.05


def test_bands_hold_the_whole_of_the_square() -> None:
    time = np.arange(800) * 0.01
    noise = np.random.default_rng(3).standard_normal((800, 2))
    np.testing.assert_allclose(energies(time, noise)[:, :3].sum(axis=1), (noise**2).mean(axis=0), rtol=1e-12)
    np.testing.assert_allclose(energies(time, noise)[:, 3:].mean(axis=1), energies(time, noise)[:, 2], rtol=1e-12)


def test_what_is_not_measured_and_steps_that_differ_make_nothing_fast() -> None:
    rng = np.random.default_rng(4)
    time = np.sort(np.arange(800) * 0.01 + rng.uniform(-0.004, 0.004, 800))
    time = np.delete(time, np.arange(500, 540))
    slow = 3.0 + np.sin(2.0 * np.pi * 2.0 * time)
    lifted = np.where((time > 1.0) & (time < 1.4), np.nan, slow)
    quick = np.where(abs(time - 3.0) < 0.2, np.sin(2.0 * np.pi * 12.0 * time), 0.0)
    found = energies(time, np.column_stack([slow, lifted, quick, np.full(time.size, np.nan)]))
    assert (found[:2, 2] < 2e-3 * found[:2, 1]).all() and (found[:2, 1] > 0.4).all()
    assert found[2, 2] > 0.9 * found[2, :3].sum() and found[2, 3 + 7] > 0.3 * found[2, 3:].sum()
    assert (found[3] == 0.0).all()


def test_a_pause_in_the_recording_hides_nothing_fast() -> None:
    time = np.delete(np.arange(600) * 0.04, np.arange(150, 450))
    found = energies(time, np.sin(2.0 * np.pi * 9.0 * time)[:, None])
    assert found[0, 2] == pytest.approx(0.25, rel=0.02)  # half the square of a sine, in half of the time
    assert found[0, 3 + PHASES // 2] < 0.01 < 0.4 < found[0, 3 + 1]


def test_a_sample_that_the_model_has_no_value_for_is_none() -> None:
    without = np.array([[False, True], [False, False], [True, False]])
    found = _placed(np.array([1.0, 2.0, 3.0, 4.0]), np.array([0, 1, 2, 4]), without)
    np.testing.assert_array_equal(found, [[1.0, np.nan], [3.0, np.nan], [np.nan, np.nan]])


def test_shares_and_floor_make_up_the_whole(elsewhere: Elsewhere, pushed: Found) -> None:
    cells, _ = pushed
    for axis in ("phase", "fast phase"):
        assert all(cell.ci95[0] <= cell.share <= cell.ci95[1] for cell in cells if cell.axis == axis)
    quiet = next(cell.floor for cell in elsewhere(located, None)[0] if cell.axis == "phase")
    loud = next(cell.floor for cell in cells if cell.axis == "phase")
    assert quiet > 0.9
    assert loud < 0.9


def test_squares_of_means_are_without_their_variance() -> None:
    rng = np.random.default_rng(0)
    noise = rng.standard_normal((5 * BLOCKS, 4, 400))
    sums, counts = noise.sum(axis=-1), np.full((5 * BLOCKS, 4), 400.0)
    gap = np.array([0.0, 0.0, 0.1, 0.3])
    (found,) = systematic(sums + counts * gap, counts, np.ones((1, 5 * BLOCKS)))
    np.testing.assert_allclose(found / counts.sum(axis=0), gap**2, atol=4e-3)


def test_a_block_that_is_drawn_twice_counts_twice() -> None:
    rng = np.random.default_rng(1)
    sums, counts = rng.standard_normal((3, 4)), rng.integers(1, 9, (3, 4)).astype(float)
    some = np.array([0, 2, 2])
    np.testing.assert_allclose(
        systematic(sums, counts, np.array([[1.0, 0.0, 2.0]])), systematic(sums[some], counts[some], np.ones((1, 3)))
    )


def test_no_gap_is_stated_where_nothing_was_measured(elsewhere: Elsewhere) -> None:
    """The push is at its height when the recording ends."""
    _, seen = elsewhere(located, Bump(7.5, 8.5, 0.5), Unmeasured(8.0))
    assert seen[0].phase[0] > 0.4 and seen[0].phase[1] < 0.55


def test_where_nothing_is_named_a_channel_that_surely_has_a_gap_comes_first() -> None:
    """A tremor of a quiet channel, a squared residual of a loud one that noise may have made."""
    loud, quiet = Window("shank", (0.3, 0.7), 0.7, 0.87), Window("thigh", (0.4, 0.7), 0.04, 0.01)
    assert in_order([loud, quiet], named=False) == (quiet, loud) == in_order([quiet, loud], named=False)
    assert in_order([quiet, loud], named=True) == (loud, quiet)


def test_p_values_of_two_families_are_doubled() -> None:
    def cell(channel: str, p_value: float) -> Cell:
        return Cell(channel, "phase", 0.0, 1.0, 0.0, 1.0, p_value, (0.0, 1.0), 0.0)

    cells = (cell("force", 0.02), cell("force", 0.3), cell("angle", 0.001), cell("calm", 0.8))
    assert [_least(cells, name) for name in ("force", "angle", "calm", "none")] == [0.04, 0.002, 1.0, 1.0]


@pytest.mark.parametrize(
    ("units", "rows"),
    [
        ({"angle": "rad", "force": "N"}, [1]),
        ({"force_x": "N", "force_y": "N", "cop_x": "m"}, [0, 1]),
        ({"angle": "rad", "torque": "N m"}, [1]),
        ({"force": "N", "torque": "N m"}, [0]),
        ({"angle": "rad"}, []),
    ],
)
def test_the_load_is_forces_else_moments_and_no_angle(units: dict[str, str], rows: list[int]) -> None:
    base = system_of(elbow_case(duration=2.0))
    system = replace(base, balance=replace(base.balance, outputs=tuple(units)), units=units)
    assert load_outputs(system) == rows


@pytest.mark.parametrize(("blocks", "columns"), [(7, 3), (30, 31), (40, 400)])
def test_family_wise_p_counts_flips_that_reach_as_far(blocks: int, columns: int) -> None:
    """Against all flips and columns at once, counted one by one; an empty column is reached by every flip."""
    rng = np.random.default_rng(columns)
    table = rng.standard_normal((blocks, columns))
    table[:, 0] += 3.0
    table[:, -1] = 0.0
    spread = rng.uniform(1.0, 1.5, columns)
    parts = [table[:, : columns // 2], table[:, columns // 2 :]]
    found = np.concatenate(family_wise(parts, spread))
    size = np.linalg.norm(table, axis=0)
    scaled = np.divide(table, size, out=np.zeros_like(table), where=size > 0.0)
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (2000, blocks))
    largest = np.abs(signs @ scaled).max(axis=1)
    reached = np.abs(scaled.sum(axis=0)) / spread
    by_hand = [(1 + sum(one >= each - 1e-12 for one in largest)) / 2001 for each in reached]
    np.testing.assert_allclose(found, by_hand, rtol=0, atol=1e-12)
    assert found[-1] == 1.0 and found[0] < 0.2


def test_what_was_left_out_does_not_outweigh_what_was_used() -> None:
    """Stretches of 3 Hz in 2 % of a trial, and 20 Hz in the one at 0.5: their energies, at their place."""
    time = np.arange(50_001) / 100.0
    value = np.full((len(time), 1), np.nan)
    begins = np.arange(0, 50_000, 5_000)
    for begin in begins:
        stretch = slice(begin, begin + 101)
        value[stretch, 0] = np.sin(2.0 * np.pi * 3.0 * (time[stretch] - time[begin]))
    there = value.copy()
    middle = slice(25_000, 25_101)
    there[middle, 0] += 0.5 * np.sin(2.0 * np.pi * 20.0 * (time[middle] - time[25_000]))
    used = 10 * 101 / (10 * 101 + 9 * 19 + 20)  # of what is looked at, with the bridges and that to the end
    slow, burst = energies(time, value)[0], energies(time, there)[0]
    assert slow[1] == pytest.approx(0.5 * used, rel=0.1)
    assert burst[2] - slow[2] == pytest.approx(0.125 * used / 10, rel=0.15)
    fast = burst[3:] - slow[3:]
    assert int(np.argmax(fast)) == PHASES // 2 and fast.max() > 0.9 * fast.sum()


def test_outputs_that_are_rarer_than_inputs_keep_their_time() -> None:
    """A swing of 3 Hz at 25 samples a second beside inputs of a thousand stays one of 1 to 5 Hz."""
    time = np.arange(4_001) / 1000.0
    value = np.full((len(time), 1), np.nan)
    value[::40, 0] = np.sin(2.0 * np.pi * 3.0 * time[::40])
    found = energies(time, value)[0]
    assert found[1] > 0.9 * found[:3].sum()
