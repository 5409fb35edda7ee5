"""The foot's force law: its formula, its limits, its exact second derivatives."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.contact.sphere_foot import friction_coefficient, normal_force

NUMBERS = (6e4, 1.5, 300.0, 2e-3)
FRICTION = (0.25, 0.9, 0.7)
DEPTHS = np.array([-1e-2, -1e-9, 0.0, 1e-13, 1e-9, 1e-4, 1.9e-3, 2e-3, 2.1e-3, 1e-2])
RATES = np.array([-0.5, 0.0, 0.3])
SPEEDS = np.array([-4.0, -3.0, -1.5, -1.2, -1.0, -0.4, 0.0, 0.4, 1.0, 1.2, 1.5, 3.0, 4.0]) * FRICTION[0]
depth = st.floats(-0.02, 0.02)
rate = st.floats(-2.0, 2.0)


def by_hand(d: float, v: float, k: float, n: float, b: float, full: float) -> float:
    """The formula with its cases spelt out."""
    if d <= 0.0:
        return 0.0
    u = d / full
    step = 1.0 if u >= 1.0 else u**2 * (3.0 - 2.0 * u)
    return k * d**n + (b * v * step if v > 0.0 else 0.0)


@pytest.fixture
def casadi() -> Iterator[Any]:
    """CasADi, with NumPy's functions applied to its symbols."""
    casadi = pytest.importorskip("casadi", reason="the extra `dynamics` is not installed")
    casadi.GlobalOptions.setNumpyMode(1)
    return casadi


@pytest.mark.parametrize("v", RATES)
def test_normal_force_is_the_formula(v: float) -> None:
    expected = [by_hand(d, v, *NUMBERS) for d in DEPTHS]
    np.testing.assert_allclose(normal_force(DEPTHS, v, *NUMBERS), expected, rtol=1e-14, atol=1e-12)


def test_friction_is_linear_between_the_nodes_of_its_table() -> None:
    v_th, mu_s, mu_k = FRICTION
    nodes, values = np.array([-3, -1.5, -1, 1, 1.5, 3]) * v_th, [-mu_k, -mu_k, -mu_s, mu_s, mu_k, mu_k]
    speeds = np.linspace(-5.0, 5.0, 2001) * v_th
    np.testing.assert_allclose(friction_coefficient(speeds, *FRICTION), np.interp(speeds, nodes, values), atol=1e-14)


@given(depth, rate)
def test_ground_only_pushes_and_parting_costs_nothing(d: float, v: float) -> None:
    force = normal_force(d, v, *NUMBERS)
    assert force >= 0.0
    assert normal_force(d, -abs(v), *NUMBERS) == normal_force(d, 0.0, *NUMBERS)
    assert d > 0.0 or force == 0.0


def test_damping_does_not_grow_with_the_elastic_force() -> None:
    """Beyond the depth of full damping it is b d' at every depth; Hunt and Crossley's is k d^n times a number."""
    (_, _, b, full), closing = NUMBERS, 0.3
    deep = np.array([1.0, 2.0, 5.0]) * full
    damping = normal_force(deep, closing, *NUMBERS) - normal_force(deep, 0.0, *NUMBERS)
    np.testing.assert_allclose(damping, b * closing, rtol=1e-12)


@given(depth, rate)
def test_force_is_continuous(d: float, v: float) -> None:
    k, n, b, full = NUMBERS
    steepest = k * n * 0.021 ** (n - 1.0) + 1.5 * b * 2.0 / full
    assert abs(normal_force(d + 1e-9, v, *NUMBERS) - normal_force(d, v, *NUMBERS)) <= 1e-9 * steepest + 1e-12


@given(st.floats(-3.0, 3.0))
def test_friction_is_odd_and_never_beyond_static(v: float) -> None:
    coefficient = friction_coefficient(v, *FRICTION)
    assert coefficient == -friction_coefficient(-v, *FRICTION)
    assert abs(coefficient) <= FRICTION[1]
    assert coefficient * v >= 0.0


@pytest.mark.parametrize("d", [-1e-3, 0.0, 1e-3])
@pytest.mark.parametrize("v", RATES)
def test_casadi_hessian_is_finite_and_right(casadi: Any, d: float, v: float) -> None:
    x = casadi.SX.sym("x", 2)
    hessian, gradient = casadi.hessian(normal_force(x[0], x[1], *NUMBERS), x)
    values = casadi.Function("hessian", [x], [hessian, gradient])([d, v])
    second, first = (np.array(value) for value in values)
    assert np.isfinite(second).all() and np.isfinite(first).all()
    if d <= 0.0:
        assert not second.any() and not first.any()
        return
    k, n, b, full = NUMBERS
    u, closing = d / full, max(v, 0.0)
    expected = k * n * (n - 1.0) * d ** (n - 2.0) + b * closing * (6.0 - 12.0 * u) / full**2
    assert math.isclose(second[0, 0], expected, rel_tol=1e-12)
    loading = {-1.0: 0.0, 0.0: 0.5, 1.0: 1.0}[float(np.sign(v))]  # CasADi takes the mean slope in a kink
    assert math.isclose(second[0, 1], b * loading * 6.0 * u * (1.0 - u) / full, rel_tol=1e-12, abs_tol=1e-9)
