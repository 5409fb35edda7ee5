"""The low-pass that stands in for that of `scipy.signal` has its numbers, to the last digit."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from scipy.signal import butter, lfilter, sosfilt, sosfilt_zi, sosfiltfilt

from geocontact.axis_misalignment.synthetic import Design, _remembered
from geocontact.identify.signals import butterworth
from geocontact.identify.signals.butterworth import filtered, sections, settled
from geocontact.identify.signals.butterworth_kernel import pass_through
from geocontact.identify.signals.filters import TWICE, zero_lag

CORNERS = [(0.01, 0.001), (0.5, 0.02), (6.0, 0.01), (17.3, 1 / 120), (40.0, 0.01), (499.0, 0.001)]


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize(("corner", "step"), CORNERS)
def test_sections_are_those_of_scipy(order: int, corner: float, step: float) -> None:
    expected = butter(order, corner, fs=1.0 / step, output="sos")
    found = sections(order, corner, step)
    assert np.array_equal(found, expected), found - expected
    assert np.array_equal(settled(found), sosfilt_zi(expected))


@pytest.mark.parametrize(("corner", "step"), CORNERS)
def test_half_of_the_power_passes_at_the_corner(corner: float, step: float) -> None:
    """By the transfer function itself, on the unit circle."""
    b, a = sections(2, corner, step)[0].reshape(2, 3)
    back = np.exp(-2j * np.pi * corner * step * np.arange(3))
    assert abs((b @ back) / (a @ back)) ** 2 == pytest.approx(0.5, rel=1e-6)


@pytest.mark.parametrize("order", [2, 3])
def test_values_and_state_are_those_of_scipy(order: int) -> None:
    rng = np.random.default_rng(3)
    low_pass = sections(order, 6.0, 0.01)
    values, state = rng.standard_normal((400, 5)), rng.standard_normal((len(low_pass), 2, 5))
    kept = values.copy(), state.copy()
    found, left = filtered(low_pass, values[::-1], state)
    expected, expected_left = sosfilt(low_pass, values[::-1], axis=0, zi=state)
    assert np.array_equal(found, expected)
    assert np.array_equal(left, expected_left)
    assert np.array_equal(values, kept[0])
    assert np.array_equal(state, kept[1])


@pytest.mark.parametrize("order", [2, 3])
def test_row_by_row_has_the_kernels_numbers(order: int) -> None:
    """Also where a sample is missing or infinite, or there is none: neither says so."""
    rng = np.random.default_rng(8)
    low_pass = sections(order, 6.0, 0.01)
    for values in (
        rng.standard_normal((400, 5)),
        rng.standard_normal((0, 2)),
        np.array([[1.0, np.inf], [np.nan, 2.0]]),
    ):
        state = rng.standard_normal((len(low_pass), 2, values.shape[1]))
        slow, slow_left, fast, left = values.copy(), state.copy(), values.copy(), state.copy()
        butterworth._row_by_row(low_pass, slow, slow_left)
        pass_through(low_pass, fast, left)
        assert np.array_equal(slow, fast, equal_nan=True)
        assert np.array_equal(slow_left, left, equal_nan=True)


def test_short_recordings_are_filtered_without_numba() -> None:
    """A process of its own: others have loaded it; long ones load it."""
    program = """
import sys
import numpy as np
from geocontact.identify.signals.filters import zero_lag
for rows in (1000, 6000):
    zero_lag(np.ones((rows, 2)), 0.01, 6.0)
    print("numba" in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]


def test_both_ways_is_that_of_scipy() -> None:
    values = np.random.default_rng(4).standard_normal((300, 3)).cumsum(axis=0)
    corner = np.arctan(np.tan(np.pi * 6.0 * 0.01) / TWICE) / (np.pi * 0.01)
    low_pass = butter(2, corner, fs=1.0 / 0.01, output="sos")
    assert np.array_equal(zero_lag(values, 0.01, 6.0), sosfiltfilt(low_pass, values, axis=0))


@pytest.mark.parametrize("kind", [int, np.uint16, bool, np.float32])
def test_values_of_any_kind_are_filtered_in_double_precision(kind: type) -> None:
    """Counts of a mat, 0 and 1 of a switch: nothing is cut to whole numbers on the way."""
    values = np.abs(10.0 * np.random.default_rng(6).standard_normal((300, 2))).astype(kind)
    low_pass = sections(2, 6.0, 0.01)
    found, _ = filtered(low_pass, values, np.zeros((1, 2, 2)))
    assert np.array_equal(found, sosfilt(low_pass, values.astype(float), axis=0))


def test_a_remembered_force_is_a_filter_of_first_order() -> None:
    design = Design(rate=100.0, noise=0.7, memory=0.25)
    white = np.random.default_rng(5).standard_normal(500)
    keep = np.exp(-1.0 / 25.0)
    white[1:] *= np.sqrt(1.0 - keep**2)
    expected = 0.7 * lfilter([1.0], [1.0, -keep], white)
    assert np.array_equal(_remembered(500, design, np.random.default_rng(5)), expected)
