"""Statistics of studies against published examples, brute force and their own promises."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from scipy.stats import permutation_test, ttest_1samp

from geocontact.study.statistics import reliability, sign_flips

SHROUT_FLEISS = np.array([[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]], float)
"""Four judges of six targets: Shrout and Fleiss (1979), table 2."""


def test_icc_of_the_published_example() -> None:
    """0.29 and 0.71: Shrout and Fleiss (1979), table 4."""
    found = reliability(SHROUT_FLEISS)
    assert found.agreement == pytest.approx(0.2898, abs=5e-5) and found.consistency == pytest.approx(0.7148, abs=5e-5)
    # intervals as R's package psych prints them for the same data
    assert found.agreement_interval == pytest.approx((0.019, 0.761), abs=1e-3)
    assert found.consistency_interval == pytest.approx((0.342, 0.946), abs=1e-3)


def test_icc_of_three_conditions_is_that_of_another_program() -> None:
    """Synthetic: 12 subjects, three conditions with a bias. pingouin 0.7.0: coefficients, and intervals to 0.01."""
    subjects = np.random.default_rng(1).normal(size=(12, 1)) * 2 + np.array([0.0, 0.5, 1.0])
    found = reliability(subjects + np.random.default_rng(2).normal(size=(12, 3)))
    assert (found.agreement, found.consistency) == pytest.approx((0.513872, 0.651726), abs=1e-6)
    assert found.agreement_interval == pytest.approx((0.13, 0.81), abs=5.1e-3)
    assert found.consistency_interval == pytest.approx((0.33, 0.87), abs=5.1e-3)


def test_icc_does_not_depend_on_unit_and_order() -> None:
    other = reliability(3.0 * SHROUT_FLEISS[::-1, [2, 0, 3, 1]] - 7.0)
    assert other.agreement == pytest.approx(reliability(SHROUT_FLEISS).agreement, rel=1e-12)
    assert reliability(np.column_stack([np.arange(5.0), np.arange(5.0) + 1.0])).consistency == 1.0


def test_t_is_student_s_and_p_counts_all_signs() -> None:
    """Seven subjects, four places: every one of 128 choices of signs, one by one."""
    d = np.random.default_rng(3).normal(0.6, 1.0, (7, 4))
    found = sign_flips(d)
    t = ttest_1samp(d, 0.0).statistic
    np.testing.assert_allclose(found.t, t, rtol=1e-12)
    largest = [
        np.abs(ttest_1samp(d * np.array(signs)[:, None], 0.0).statistic).max()
        for signs in product((1.0, -1.0), repeat=7)
    ]
    expected = [(np.array(largest) >= abs(each) * (1 - 1e-10)).mean() for each in t]
    np.testing.assert_allclose(found.p, expected, atol=1e-15)
    assert found.exact and found.flips == 128 and found.smallest == 2 / 128
    assert ((np.abs(found.t) >= found.critical * (1 - 1e-10)) == (found.p <= 0.05)).all()


def test_one_place_is_the_permutation_test_of_scipy() -> None:
    d = np.random.default_rng(4).normal(0.4, 1.0, (9, 1))
    theirs = permutation_test(
        (d[:, 0],),
        lambda x: abs(x.mean()),
        permutation_type="samples",
        n_resamples=np.inf,
        alternative="greater",
        vectorized=False,
    )
    assert sign_flips(d).p[0] == pytest.approx(theirs.pvalue, abs=1e-12)


def test_false_findings_anywhere_on_the_curve_are_as_rare_as_promised() -> None:
    """300 smooth curves of 8 subjects without a difference: 5 % ± 3 SD have p below 5 % anywhere."""
    rng = np.random.default_rng(5)
    found = [(sign_flips(gaussian_filter1d(rng.normal(size=(8, 60)), 5.0, axis=1)).p <= 0.05).any() for _ in range(300)]
    assert abs(np.mean(found) - 12 / 256) < 3 * np.sqrt(0.05 * 0.95 / 300)


def test_what_is_equal_and_what_cannot_be_told() -> None:
    two = sign_flips(np.array([[1.0, 0.0], [1.1, 0.0]]))
    assert two.p[0] >= two.smallest == 0.5 and two.critical == np.inf and (two.t[1], two.p[1]) == (0.0, 1.0)
    many = sign_flips(np.random.default_rng(6).normal(1.0, 0.5, (20, 3)))
    assert not many.exact and many.flips == 10_000 and many.p.max() < 0.01 and many.critical < 6.0
    with pytest.raises(ValueError, match="at least two"):
        sign_flips(np.ones((1, 3)))
