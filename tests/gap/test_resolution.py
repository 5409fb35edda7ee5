"""The steps of a recorder are found, whatever the unit and however quickly the channel moves."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.inputs.spectrum import resolution


@pytest.mark.parametrize("unit", [1.0, 1e-9])
@pytest.mark.parametrize("seed", range(5))
def test_steps_are_found(seed: int, unit: float) -> None:
    rng = np.random.default_rng(seed)
    time = 0.02 * np.arange(400)
    moved = np.sin(2.0 * np.pi * 0.5 * time + rng.uniform(0.0, 6.0)) + 0.002 * rng.standard_normal(400)
    written = unit * 5e-4 * np.round(moved / 5e-4)
    assert resolution([written]) == pytest.approx(5e-4 * unit)


def test_a_channel_that_hardly_rests_has_them_too() -> None:
    steps = 3e-3 * np.cumsum(np.random.default_rng(0).choice([-7, -5, 5, 7], 300))
    assert resolution([steps]) == pytest.approx(3e-3)


def test_what_is_written_in_full_has_none() -> None:
    assert resolution([np.random.default_rng(0).standard_normal(300)]) == 0.0
    assert resolution([]) == 0.0
