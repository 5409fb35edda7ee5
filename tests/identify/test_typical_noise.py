"""Noise from medians: of values, of differences, with a few large values among them."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.identify.noise.noise_levels import typical_noise

SD = 0.7


@pytest.mark.parametrize("order", [0, 2, 4])
def test_white_noise_is_told_from_its_differences(order: int) -> None:
    values = SD * np.random.default_rng(0).standard_normal(40_000)
    assert typical_noise(np.diff(values, order), order) == pytest.approx(SD, rel=0.03)


def test_a_few_large_values_do_not_move_it() -> None:
    values = SD * np.random.default_rng(1).standard_normal(40_000)
    values[::50] *= 1000.0
    assert typical_noise(values) == pytest.approx(SD, rel=0.05)
    assert typical_noise(np.zeros(0)) == 0.0
