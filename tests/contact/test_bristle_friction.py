"""Friction with memory: where it sticks and where it slides; `test_every_law` runs it in loops and on symbols."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.contact.bristle_friction import bristle_force, deflection_rate

LARGEST, ELASTIC = 4e-5, 0.6
DEFLECTIONS = np.array([-5e-5, -4e-5, -3e-5, 0.0, 1e-5, 2.4e-5, 3e-5, 3.7e-5, 4e-5])
SPEEDS = np.array([-1.0, -1e-6, 0.0, 1e-9, 2e-3, 1.0])
PAIRS = [(s, v) for s in DEFLECTIONS.tolist() for v in SPEEDS.tolist()]


def test_what_is_bent_little_follows_the_motion() -> None:
    """Up to the elastic part, either way, and always on the way back."""
    for s in (-2e-5, 0.0, 1e-5, ELASTIC * LARGEST):
        np.testing.assert_array_equal(deflection_rate(s, SPEEDS, LARGEST, ELASTIC), SPEEDS)
    assert deflection_rate(3.9e-5, -0.1, LARGEST, ELASTIC) == -0.1


def test_at_the_largest_deflection_it_slides() -> None:
    """Either way, and between the two it slips the more the farther it is bent."""
    assert deflection_rate(LARGEST, 0.3, LARGEST, ELASTIC) == pytest.approx(0.0, abs=1e-16)
    assert deflection_rate(-LARGEST, -0.3, LARGEST, ELASTIC) == pytest.approx(0.0, abs=1e-16)
    rates = deflection_rate(np.linspace(ELASTIC, 1.0, 30) * LARGEST, 0.3, LARGEST, ELASTIC)
    assert (np.diff(rates) < 0.0).all() and rates[0] == 0.3


def test_odd_in_motion_and_deflection() -> None:
    for s, v in PAIRS:
        assert deflection_rate(-s, -v, LARGEST, ELASTIC) == -deflection_rate(s, v, LARGEST, ELASTIC)


def test_force_is_a_spring_and_a_damper_against_the_motion() -> None:
    assert bristle_force(1e-5, 2e-3, 1e5, 30.0) == pytest.approx(-(1.0 + 0.06))
