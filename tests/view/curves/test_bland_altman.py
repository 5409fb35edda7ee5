"""Limits of agreement: by hand, as published, and by simulation."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.view.curves.bland_altman import bland_altman, limits_of_agreement, proportional_bias
from geocontact.view.curves.quantity import AREA, Quantity

# Peak expiratory flow [l/min] of 17 subjects, first readings, Wright and mini Wright meter: Bland and Altman (1986),
# table 1, and what that paper finds from them.
WRIGHT = np.array([494, 395, 516, 434, 476, 557, 413, 442, 650, 433, 417, 656, 267, 478, 178, 423, 427], float)
MINI = np.array([512, 430, 520, 428, 500, 600, 364, 380, 658, 445, 432, 626, 260, 477, 259, 350, 451], float)


def test_by_hand() -> None:
    found = limits_of_agreement(np.array([1.0, 2.0, 3.0, 4.0, 5.0]))
    t, sd = 2.7764451052, np.sqrt(2.5)
    assert (found.count, found.bias) == (5, 3.0)
    assert found.sd == pytest.approx(sd, rel=1e-14)
    assert (found.lower, found.upper) == pytest.approx((3.0 - 1.96 * sd, 3.0 + 1.96 * sd), rel=1e-14)
    half = t * sd / np.sqrt(5.0)
    assert found.bias_interval == pytest.approx((3.0 - half, 3.0 + half), rel=1e-9)
    half = t * np.sqrt(2.5 / 5.0 + 1.96**2 * 2.5 / 8.0)
    assert found.lower_interval == pytest.approx((found.lower - half, found.lower + half), rel=1e-9)
    assert found.upper_interval == pytest.approx((found.upper - half, found.upper + half), rel=1e-9)


def test_as_published() -> None:
    found = limits_of_agreement(WRIGHT - MINI)
    assert found.bias == pytest.approx(-2.1, abs=0.05)
    assert found.sd == pytest.approx(38.8, abs=0.05)
    assert found.bias_interval == pytest.approx((-22.0, 17.8), abs=0.1)
    # There: 2 SD instead of 1.96, standard error sqrt(3 s²/n)
    assert (found.lower, found.upper) == pytest.approx((-79.7, 75.5), abs=0.04 * 38.8 + 0.1)
    assert found.lower_interval == pytest.approx((-114.3, -45.1), abs=2.5)
    assert found.upper_interval == pytest.approx((40.9, 110.1), abs=2.5)


@pytest.mark.parametrize("count", [20, 60])
def test_intervals_cover_what_they_should(count: int) -> None:
    rng = np.random.default_rng(count)
    bias, sd, samples = 4.0, 10.0, 4000
    hit = np.zeros(3)
    for difference in rng.normal(bias, sd, (samples, count)):
        f = limits_of_agreement(difference)
        cases = ((f.bias_interval, 0.0), (f.lower_interval, -1.96), (f.upper_interval, 1.96))
        hit += [low <= bias + z * sd <= high for (low, high), z in cases]
    assert hit[0] / samples == pytest.approx(0.95, abs=0.011)  # exact; 3 standard errors of 4000 samples
    assert hit[1:] / samples == pytest.approx(0.95, abs=0.02)  # the approximation of 1999


def test_drawn_lines_bands_and_numbers_are_these() -> None:
    axes = bland_altman(WRIGHT, MINI, Quantity("peak flow", "l/min"), ("Wright", "mini")).axes[0]
    found = limits_of_agreement(WRIGHT - MINI)
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), (WRIGHT + MINI) / 2.0)
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), WRIGHT - MINI)
    for line, value in zip(axes.lines[1:4], (found.bias, found.lower, found.upper), strict=True):
        np.testing.assert_array_equal(line.get_ydata(), value)
    intervals = (found.bias_interval, found.lower_interval, found.upper_interval)
    for patch, interval in zip(axes.patches, intervals, strict=True):
        assert (patch.get_y(), patch.get_y() + patch.get_height()) == pytest.approx(interval, rel=1e-12)
    assert [text.get_text() for text in axes.texts] == [
        "bias: −2.1\n[−22.0, 17.8]",
        "−1.96 SD: −78.1\n[−112.9, −43.3]",
        "+1.96 SD: 73.9\n[39.1, 108.6]",
    ]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("mean peak flow [l/min]", "Wright − mini [l/min]")


def test_units_and_missing_pairs() -> None:
    first, second = np.array([100.0, 210.0, 300.0, np.nan, 5.0]), np.array([90.0, 190.0, 270.0, 4.0, np.nan])
    axes = bland_altman(first * 1e-6, second * 1e-6, AREA, ("mesh", "film")).axes[0]
    np.testing.assert_allclose(axes.lines[0].get_xydata(), [[95.0, 10.0], [200.0, 20.0], [285.0, 30.0]], rtol=1e-12)
    assert axes.get_ylabel() == "mesh − film [mm²]"
    legend = axes.get_legend()
    assert legend is not None and legend.get_texts()[0].get_text() == "pairs (n = 3)"


def test_slope_is_that_of_least_squares_and_its_interval_covers() -> None:
    rng = np.random.default_rng(8)
    mean = rng.uniform(0.0, 10.0, 25)
    hit = 0
    for _ in range(1000):
        difference = 1.0 + 0.3 * mean + rng.standard_normal(25)
        found = proportional_bias(mean, difference)
        hit += found.slope_interval[0] <= 0.3 <= found.slope_interval[1]
    assert (found.slope, found.intercept) == pytest.approx(tuple(np.polyfit(mean, difference, 1)), rel=1e-9)
    assert hit / 1000 == pytest.approx(0.95, abs=0.021)
    axes = bland_altman(
        mean + difference / 2.0, mean - difference / 2.0, Quantity("x", "N"), ("a", "b"), None, True
    ).axes[0]
    x, y = axes.lines[4].get_data()
    np.testing.assert_allclose(y, found.intercept + found.slope * x, rtol=1e-9)


def test_numbers_in_the_margin_stay_apart_where_an_outlier_draws_the_lines_together() -> None:
    rng = np.random.default_rng(2)
    first = np.r_[rng.normal(100.0, 1.0, 400), 400.0]
    figure = bland_altman(first, np.full(401, 100.0), Quantity("force", "N"), ("a", "b"))
    figure.draw_without_rendering()
    bias, lower, upper = (text.get_window_extent() for text in figure.axes[0].texts)
    assert lower.y1 < bias.y0 and bias.y1 < upper.y0
    assert lower.y0 > 0.0


@pytest.mark.usefixtures("unchecked")
def test_what_cannot_be_drawn_is_refused() -> None:
    with pytest.raises(ValueError, match="mesh has 17 values, film has 16; expected pairs"):
        bland_altman(WRIGHT, MINI[:-1], AREA, ("mesh", "film"))
    with pytest.raises(ValueError, match=r"film: shape \(17, 1\), expected \(n,\)"):
        bland_altman(WRIGHT, MINI[:, None], AREA, ("mesh", "film"))
    with pytest.raises(ValueError, match="2 pairs without NaN, expected at least 3"):
        bland_altman(WRIGHT[:2], MINI[:2], AREA, ("mesh", "film"))
    with pytest.raises(ValueError, match="all means of pairs are equal"):
        bland_altman(np.array([1.0, 2.0, 3.0]), np.array([3.0, 2.0, 1.0]), AREA, ("mesh", "film"), slope=True)
