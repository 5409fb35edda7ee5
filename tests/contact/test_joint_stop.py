"""Stops of joints: closed form, smoothness, no pull, energy, and symbols beside numbers."""

from __future__ import annotations

import casadi
import numpy as np
import pytest

from geocontact.contact.joint_stop import stop_force
from geocontact.dynamics.symbols import apply_numpy

NUMBERS = (-0.5, 1.5, 200.0, 0.02, 3.0)


def test_force_is_that_of_the_text_on_both_sides() -> None:
    lower, upper, k, width, _ = NUMBERS
    assert stop_force(1.0, 5.0, *NUMBERS) == 0.0
    assert stop_force(upper + 0.01, 0.0, *NUMBERS) == pytest.approx(-k * 0.01**2 / (2 * width))
    assert stop_force(upper + 0.1, 0.0, *NUMBERS) == pytest.approx(-k * (0.1 - width / 2))
    assert stop_force(lower - 0.1, 0.0, *NUMBERS) == pytest.approx(k * (0.1 - width / 2))
    assert stop_force(upper + 0.1, 0.2, *NUMBERS) == pytest.approx(-k * (0.1 - width / 2) * 1.6)
    assert stop_force(upper + 0.1, -1.0, *NUMBERS) == 0.0
    assert stop_force(lower - 0.1, -0.2, *NUMBERS) == pytest.approx(k * (0.1 - width / 2) * 1.6)
    assert stop_force(lower - 0.1, 1.0, *NUMBERS) == 0.0


def test_it_is_once_continuously_differentiable_in_the_coordinate() -> None:
    value = np.linspace(-0.6, 1.6, 220001)
    slope = np.gradient(stop_force(value, 0.1, *NUMBERS), value)
    assert np.abs(np.diff(slope)).max() < 0.2  # 200 without the soft beginning


def test_a_way_in_and_out_takes_energy() -> None:
    t = np.linspace(0.0, 1.0, 5001)
    value, rate = 1.5 + 0.05 * np.sin(np.pi * t), 0.05 * np.pi * np.cos(np.pi * t)
    assert np.trapezoid(stop_force(value, rate, *NUMBERS) * rate, t) < -0.05


def test_symbols_and_numbers_agree() -> None:
    apply_numpy()
    x = casadi.SX.sym("x", 2)
    run = casadi.Function("f", [x], [stop_force(x[0], x[1], *NUMBERS)])
    for value, rate in np.random.default_rng(0).uniform(-2, 2, (20, 2)):
        assert float(run([value, rate])) == pytest.approx(float(stop_force(value, rate, *NUMBERS)), abs=1e-9)
