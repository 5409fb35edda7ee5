"""Histogram and quantile-quantile plot, against theory, scipy and simulation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from geocontact.view.curves.quantity import AREA, FORCE
from geocontact.view.curves.residuals import normal_quantiles, residual_figure, residual_histogram, residual_quantiles

SAMPLE = np.random.default_rng(3).normal(4e-6, 20e-6, 150)


def test_histogram_is_a_density_and_the_curve_is_the_normal_one() -> None:
    axes = residual_histogram(SAMPLE, AREA).axes[0]
    bars = axes.patches
    assert sum(bar.get_width() * bar.get_height() for bar in bars) == pytest.approx(1.0, rel=1e-12)
    counts = [np.sum(np.floor((SAMPLE * 1e6 - b.get_x()) / b.get_width()) == 0.0) for b in bars[:-1]]
    heights = [bar.get_height() * bar.get_width() * 150 for bar in bars[:-1]]
    np.testing.assert_allclose(counts, heights, rtol=1e-9, atol=1e-9)
    x, y = axes.lines[0].get_data()
    mean, sd = 1e6 * SAMPLE.mean(), 1e6 * SAMPLE.std(ddof=1)
    np.testing.assert_allclose(y, np.exp(-(((x - mean) / sd) ** 2) / 2) / (sd * np.sqrt(2 * np.pi)), rtol=1e-12)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("residual contact area [mm²]", "density [1/mm²]")
    legend = axes.get_legend()
    assert legend is not None
    assert [t.get_text() for t in legend.get_texts()] == [
        "residual (n = 150)",
        f"normal, mean {mean:.1f}, SD {sd:.1f} mm²".replace("-", "−"),
    ]


def test_quantiles_agree_with_scipy_and_with_theory() -> None:
    axes = residual_quantiles(SAMPLE * 1e6, FORCE).axes[0]
    x, y = axes.lines[1].get_data()
    theirs, ordered = stats.probplot(SAMPLE * 1e6, fit=False)
    np.testing.assert_array_equal(y, ordered)
    np.testing.assert_allclose(x, theirs, atol=2e-3)  # Filliben's approximation of the medians there
    rank = np.arange(1, 151)
    np.testing.assert_allclose(stats.binom.sf(rank - 1, 150, stats.norm.cdf(x)), 0.5, rtol=1e-9)
    at, line = axes.lines[0].get_data()
    np.testing.assert_allclose(line, ordered.mean() + ordered.std(ddof=1) * at, rtol=1e-12)


def test_band_holds_95_percent_of_normal_samples_entirely() -> None:
    rng = np.random.default_rng(11)
    inside, significant = 0, 0
    for _ in range(1000):
        q = normal_quantiles(rng.normal(5.0, 3.0, 30))
        within = bool(((q.ordered >= q.lower) & (q.ordered <= q.upper)).all())
        inside += within
        significant += q.p <= 0.05
        assert within == (q.p > 0.05) or abs(q.p - 0.05) < 0.002, "band and p are one test"
    assert inside / 1000 == pytest.approx(0.95, abs=0.025)  # 0.7 % from these samples, 0.5 % from the simulated ones


@pytest.mark.slow
def test_band_holds_for_large_samples_of_which_not_all_ranks_are_simulated() -> None:
    rng = np.random.default_rng(12)
    bands = (normal_quantiles(rng.standard_normal(3000)) for _ in range(200))
    inside = np.mean([((q.ordered >= q.lower) & (q.ordered <= q.upper)).all() for q in bands])
    assert inside == pytest.approx(0.95, abs=0.05)


def test_heavy_tails_and_skew_leave_the_band() -> None:
    rng = np.random.default_rng(4)
    assert normal_quantiles(rng.standard_t(2, 200)).p < 0.01
    assert normal_quantiles(rng.exponential(1.0, 200)).p < 0.01


def test_unit_and_offset_do_not_matter() -> None:
    one, other = normal_quantiles(SAMPLE), normal_quantiles(1e6 * SAMPLE - 3.0)
    assert one.p == other.p
    np.testing.assert_allclose(other.lower, 1e6 * one.lower - 3.0, rtol=1e-9)
    np.testing.assert_allclose(other.upper, 1e6 * one.upper - 3.0, rtol=1e-9)
    mirrored = normal_quantiles(-SAMPLE)
    np.testing.assert_allclose(mirrored.lower, -one.upper[::-1], rtol=1e-9)


def test_missing_values_are_not_counted() -> None:
    gated = np.r_[SAMPLE, np.nan, np.nan]
    figure = residual_figure(gated, AREA)
    for axes in figure.axes:
        legend = axes.get_legend()
        assert legend is not None and legend.get_texts()[0].get_text() == "residual (n = 150)"


@pytest.mark.usefixtures("unchecked")
@pytest.mark.parametrize(
    ("residual", "said"),
    [
        (np.array([1.0, np.nan, 2.0]), "residual: 2 values that are not NaN, expected at least 3"),
        (np.ones(9), "residual: all 9 values are 1; a constant has no distribution"),
        (np.ones((9, 2)), r"residual: shape \(9, 2\), expected \(n,\)"),
        (np.array([1.0, 2.0, np.inf]), "residual: 1 infinite values"),
    ],
)
def test_what_cannot_be_drawn_is_refused(residual: np.ndarray, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        residual_quantiles(residual, FORCE)


def test_a_constant_still_has_a_histogram() -> None:
    axes = residual_histogram(np.full(9, 2.0), FORCE).axes[0]
    assert sum(bar.get_width() * bar.get_height() for bar in axes.patches) == pytest.approx(1.0)
