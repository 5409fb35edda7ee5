"""Making a case ready: the search for how far rates are smoothed."""

from __future__ import annotations

import pytest

from geocontact.gap.case.preparation import REACHES, best_of


@pytest.mark.parametrize("peak", REACHES)
def test_the_best_of_ordered_points_is_found_without_trying_all(peak: float) -> None:
    tried: list[float] = []

    def likelihood(point: float) -> float:
        tried.append(point)
        return -abs(REACHES.index(point) - REACHES.index(peak))

    assert best_of(likelihood, REACHES) == peak
    assert len(tried) == len(set(tried)) <= 4 < len(REACHES)


def test_two_that_are_alike_are_no_peak_between_them() -> None:
    assert best_of(lambda point: 0.0, REACHES) in REACHES
