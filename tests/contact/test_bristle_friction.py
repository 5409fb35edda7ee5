"""Friction with memory: where it sticks, where it slides, and the same on arrays, in loops and on symbols."""

from __future__ import annotations

import inspect

import numba
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


def test_loops_and_symbols_agree_with_the_array() -> None:
    casadi = pytest.importorskip("casadi", reason="the extra `dynamics` is not installed")
    casadi.GlobalOptions.setNumpyMode(1)
    loop = numba.njit(inspect.unwrap(deflection_rate))
    s, v = casadi.SX.sym("s"), casadi.SX.sym("v")
    rate = deflection_rate(s, v, LARGEST, ELASTIC)
    both = casadi.vertcat(s, v)
    symbolic = casadi.Function("rate", [s, v], [rate, casadi.gradient(rate, both), casadi.hessian(rate, both)[0]])
    for each in PAIRS:
        wanted = deflection_rate(*each, LARGEST, ELASTIC)
        assert loop(*each, LARGEST, ELASTIC) == pytest.approx(wanted, rel=1e-13, abs=1e-18)
        value, slope, curve = (np.array(x) for x in symbolic(*each))
        assert float(value.item()) == pytest.approx(wanted, rel=1e-13, abs=1e-18)
        assert np.isfinite(slope).all() and np.isfinite(curve).all()
    slope = np.array(symbolic(3e-5, 0.2)[1]).ravel()
    step = 1e-9
    high, low = (deflection_rate(3e-5 + d, 0.2, LARGEST, ELASTIC) for d in (step, -step))
    assert slope[0] == pytest.approx((high - low) / (2 * step), rel=1e-6)
