"""Every law of the catalogue, four ways from one source: array, numba loop, CasADi value, CasADi derivatives."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest

import geocontact.contact as room
from geocontact.contact.catalogue import FRICTION, HOLDING, LAWS, PRESSING, ForceLaw

SHARES = (-2.0, -1e-6, 0.0, 1e-9, 1e-3, 0.3, 1.0, 1.7, 5.0)
"""Of the typical value of each variable, all combinations."""
STEP = 1e-4
"""Of the typical value, for differences."""
laws = pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)


def typical(law: ForceLaw) -> np.ndarray:
    return np.array([variable.typical for variable in law.variables])


def points(law: ForceLaw) -> np.ndarray:
    """All combinations of shares, (variables, combinations)."""
    return np.array(list(product(SHARES, repeat=len(law.variables)))).T * typical(law)[:, None]


def value(law: ForceLaw, at: np.ndarray) -> Any:
    return law.function(*at, *law.numbers)


@pytest.fixture(scope="module")
def casadi() -> Iterator[Any]:
    """CasADi, with NumPy's functions applied to its symbols."""
    casadi = pytest.importorskip("casadi", reason="the extra `dynamics` is not installed")
    casadi.GlobalOptions.setNumpyMode(1)
    return casadi


@pytest.mark.parametrize("law", PRESSING, ids=lambda law: law.name)
def test_bodies_only_push_and_harder_when_deeper(law: ForceLaw) -> None:
    first, *others = typical(law)
    x = np.linspace(-1.0, 3.0, 4001) * first
    for signs in product((-1.0, 0.0, 1.0), repeat=len(others)):
        force = law.function(x, *(np.array(signs) * others), *law.numbers)
        assert (force[x <= 0.0] == 0.0).all()
        assert (np.diff(force) >= 0.0).all() and force[-1] > 0.0


@pytest.mark.parametrize("law", FRICTION + HOLDING, ids=lambda law: law.name)
def test_friction_and_bushings_turn_with_the_motion(law: ForceLaw) -> None:
    at = points(law)
    np.testing.assert_array_equal(value(law, -at), -value(law, at))
    assert value(law, 0.0 * typical(law)) == 0.0 and value(law, typical(law)) != 0.0


@laws
def test_numba_loop_agrees_with_the_array(law: ForceLaw) -> None:
    compiled, at = numba.njit(inspect.unwrap(law.function)), points(law)
    looped = [compiled(*one, *law.numbers) for one in at.T.tolist()]
    np.testing.assert_allclose(looped, value(law, at), rtol=1e-13, atol=0.0)


@laws
def test_casadi_value_agrees_with_the_array(law: ForceLaw, casadi: Any) -> None:
    x, at = casadi.SX.sym("x", len(law.variables)), points(law)
    symbolic = casadi.Function("law", [x], [value(law, casadi.vertsplit(x))])
    values = [float(symbolic(one)) for one in at.T]
    np.testing.assert_allclose(values, value(law, at), rtol=1e-12, atol=0.0)


@laws
def test_casadi_derivatives_are_finite_and_right(law: ForceLaw, casadi: Any) -> None:
    """Finite everywhere; below and above 0 of each variable, against differences of the array's values."""
    x = casadi.SX.sym("x", len(law.variables))
    hessian, gradient = casadi.hessian(value(law, casadi.vertsplit(x)), x)
    derivatives = casadi.Function("derivatives", [x], [casadi.densify(gradient), casadi.densify(hessian)])
    for at in points(law).T:
        slope, curve = (np.array(of) for of in derivatives(at))
        assert np.isfinite(slope).all() and np.isfinite(curve).all(), at
        if law in PRESSING and at[0] < 0.0:
            assert not slope.any() and not curve.any(), at
    size = typical(law)
    largest = abs(value(law, size))
    for signs in product((-1.0, 1.0), repeat=len(size)):
        slope, curve = (np.array(of) for of in derivatives(np.array(signs) * size))
        first, second = differences(law, np.array(signs) * size)
        np.testing.assert_allclose(slope[:, 0] * size, first, rtol=1e-6, atol=1e-8 * largest, err_msg=str(signs))
        scaled = curve * np.outer(size, size)
        np.testing.assert_allclose(scaled, second, rtol=1e-4, atol=1e-6 * largest, err_msg=str(signs))


def differences(law: ForceLaw, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gradient and second derivatives by central differences, per share of the typical values."""
    steps = STEP * np.diag(typical(law))
    first = [(value(law, at + h) - value(law, at - h)) / (2.0 * STEP) for h in steps]
    second = [
        [
            sum(i * j * value(law, at + i * a + j * b) for i in (1, -1) for j in (1, -1)) / (2.0 * STEP) ** 2
            for b in steps
        ]
        for a in steps
    ]
    return np.array(first), np.array(second)


def test_no_law_is_left_out() -> None:
    """What presses or rubs, by its name, is in the catalogue."""
    names = set()
    for file in Path(room.__file__ or "").parent.glob("*.py"):
        module = import_module(f"geocontact.contact.{file.stem}")
        functions = inspect.getmembers(module, inspect.isfunction)
        names |= {n for n, f in functions if f.__module__ == module.__name__ and not n.startswith("_")}
    acting = {n for n in names if n.endswith(("_force", "_load", "_pressure", "_coefficient", "_rate"))}
    of_a_known_force = {n for n in acting if "peak" in n}
    of_a_coordinate = {"stop_force"}  # presses at both ends of a range; test_joint_stop
    assert acting - of_a_known_force - of_a_coordinate == {law.name for law in LAWS}
