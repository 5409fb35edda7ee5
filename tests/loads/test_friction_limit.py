"""Shear beside Coulomb's limit, on curves whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.loads.friction_limit import friction_limit, noise_of

TIME = np.linspace(0.0, 10.0, 2001)


def test_the_share_beyond_the_limit_is_that_of_the_circle() -> None:
    """|sin| is above 1/2 for two thirds of a period, however large the normal force is."""
    normal = np.full(len(TIME), 40.0)
    found = friction_limit(20.0 * np.sin(2.0 * np.pi * TIME), normal, 0.25)
    assert found.beyond == pytest.approx(2.0 / 3.0, abs=0.01)  # one sample of the hundred in each half wave
    assert found.largest == pytest.approx(0.5, abs=1e-9)
    assert found.usual == pytest.approx(0.5 * np.sin(0.25 * np.pi), abs=1e-3)
    assert TIME[found.first] == pytest.approx(1.0 / 12.0, abs=6e-3)
    assert not found.kept


def test_noise_alone_exceeds_no_limit() -> None:
    """Sliding at the limit with noise of 1 N: 3 standard deviations are exceeded by 0.13 % of the samples."""
    rng = np.random.default_rng(1)
    normal = 30.0 + 10.0 * np.sin(TIME)
    shear = 0.8 * normal + rng.normal(0.0, 1.0, len(TIME))
    found = friction_limit(shear, normal, 0.8)
    assert found.noise == pytest.approx(1.0, rel=0.1)
    assert found.kept
    assert friction_limit(shear, normal, 0.7).beyond > 0.3


def test_values_between_samples_have_the_noise_of_the_samples() -> None:
    """A recording at a fifth of the rate: straight lines between samples bend in every fifth value only."""
    rng = np.random.default_rng(2)
    slow = TIME[::5]
    normal = 30.0 + 10.0 * np.sin(slow)
    recorded = 0.8 * normal + rng.normal(0.0, 1.0, len(slow))
    shear, pressed = np.interp(TIME, slow, recorded), np.interp(TIME, slow, normal)
    assert not friction_limit(shear, pressed, 0.8).kept, "noise of the lines: none"
    found = friction_limit(shear, pressed, 0.8, noise_of(recorded))
    assert found.noise == pytest.approx(1.0, rel=0.1)
    assert found.kept


def test_what_is_not_known_does_not_count() -> None:
    shear, normal = np.sin(TIME), np.full(len(TIME), 0.5)
    shear[500:] = np.nan
    found = friction_limit(shear, normal, 1.0)
    assert found.samples == 500
    assert friction_limit(np.full(9, np.nan), np.ones(9), 1.0).beyond == 0.0
    assert noise_of(np.ones(2)) == 0.0
    assert friction_limit(-np.ones(9), -np.ones(9), 1.0).beyond == 1.0  # a pull has no friction
