"""Noise with heavy tails: degrees of freedom are found, normal noise has none, and no weighed sample is large."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.identify.noise.student import student_noise

RNG = np.random.default_rng(3)


@pytest.mark.parametrize("degrees", [2.0, 4.0])
def test_degrees_and_scale_are_found(degrees: float) -> None:
    found = student_noise(0.7 * RNG.standard_t(degrees, 6000))
    assert found.degrees == pytest.approx(degrees, abs=0.5)
    assert found.scale == pytest.approx(0.7, rel=0.06)
    assert found.gain > 100.0


def test_normal_noise_has_no_tails() -> None:
    assert student_noise(RNG.standard_normal(6000)).gain < 0.0


def test_what_is_all_zero_has_none() -> None:
    assert student_noise(np.zeros(50)).gain == 0.0


def test_samples_and_stretches_are_bounded() -> None:
    quiet, burst = RNG.standard_normal(2000), 20.0 + RNG.standard_normal(60)
    found = student_noise(np.concatenate([quiet, burst]))
    squares = (burst / found.scale) ** 2
    alone, (together, calm) = found.weights(burst), found.weights_of_stretches([burst, quiet[:60]])
    assert (alone * squares).max() <= found.degrees + 1.0
    assert float((alone * squares).sum()) > 1.5 * 60.0, "each bounded, all of them still loud"
    assert float((together * squares).sum()) <= found.degrees + 60.0
    assert calm == pytest.approx(found.weights(quiet[:60]), rel=0.5)
