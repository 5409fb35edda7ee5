"""Intervals by profile where there are several minima: the ends that can be worked by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.parameter import Parameter
from geocontact.identify.intervals.profile_likelihood import Profile, profile_of

NUMBER = Parameter("x", "m", 1.0, -3.0, 2.5)


def two_wells(cut: float) -> Profile:
    """Of (x² - 1)², whose ends at a cut c are the roots of 1 ± √c, either sign."""
    return profile_of(lambda x: (x**2 - 1.0) ** 2, 0.0, NUMBER, 1.0, np.sqrt(cut / 4.0), 0.25, 5, [-1.0])


def test_minima_that_the_cut_keeps_apart_have_intervals_of_their_own() -> None:
    found = two_wells(0.25)
    inner, outer = np.sqrt(0.5), np.sqrt(1.5)
    np.testing.assert_allclose(found.parts, [(-outer, -inner), (inner, outer)], rtol=1e-7)
    assert (found.lower, found.upper) == (found.parts[0][0], found.parts[1][1])
    assert not (found.lower_open or found.upper_open)


def test_minima_without_a_wall_between_them_share_one() -> None:
    ((low, high),) = two_wells(1.44).parts
    assert [low, high] == pytest.approx([-np.sqrt(2.2), np.sqrt(2.2)], rel=1e-7)


def test_a_minimum_above_the_cut_has_none() -> None:
    tilted = profile_of(lambda x: (x**2 - 1.0) ** 2 + 1.0 - x, 0.0, NUMBER, 1.0, 0.25, 0.25, 5, [-1.0])
    ((low, high),) = tilted.parts
    assert 0.0 < low < 1.0 < high


def test_a_side_without_a_wall_is_open() -> None:
    found = profile_of(lambda x: max(1.0 - x, 0.0) ** 2, 0.0, NUMBER, 1.0, 0.5, 1.0, 5)
    assert found.upper_open and found.upper == NUMBER.upper and not found.lower_open
    assert found.lower == pytest.approx(0.5)
