"""Every law of the catalogue, four ways from one source: array, numba loop, CasADi value, CasADi derivatives."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from typing import Any

import numba
import numpy as np
import pytest

import geocontact.contact as room
from geocontact.contact.catalogue import LAWS, Law

SHARES = np.array([-2.0, -1e-6, 0.0, 1e-9, 1e-3, 0.3, 1.0, 1.7])
laws = pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)


@pytest.fixture(scope="module")
def casadi() -> Iterator[Any]:
    """CasADi, with NumPy's functions applied to its symbols."""
    casadi = pytest.importorskip("casadi", reason="the extra `dynamics` is not installed")
    casadi.GlobalOptions.setNumpyMode(1)
    return casadi


@laws
def test_bodies_only_push_and_harder_when_deeper(law: Law) -> None:
    x = np.linspace(-1.0, 3.0, 4001) * law.typical
    force = law.function(x, *law.numbers)
    assert (force[x <= 0.0] == 0.0).all()
    assert (np.diff(force) >= 0.0).all() and force[-1] > 0.0


@laws
def test_numba_loop_agrees_with_the_array(law: Law) -> None:
    compiled = numba.njit(inspect.unwrap(law.function))
    looped = [compiled(x, *law.numbers) for x in (SHARES * law.typical).tolist()]
    expected = law.function(SHARES * law.typical, *law.numbers)
    np.testing.assert_allclose(looped, expected, rtol=1e-13, atol=0.0)


@laws
def test_casadi_value_agrees_with_the_array(law: Law, casadi: Any) -> None:
    x = casadi.SX.sym("x")
    symbolic = casadi.Function("law", [x], [law.function(x, *law.numbers)])
    values = [float(symbolic(share * law.typical)) for share in SHARES]
    np.testing.assert_allclose(values, law.function(SHARES * law.typical, *law.numbers), rtol=1e-12, atol=0.0)


@laws
@pytest.mark.parametrize("share", [-1.0, 0.0, 1.0])
def test_casadi_derivatives_are_finite_and_right(law: Law, casadi: Any, share: float) -> None:
    x = casadi.SX.sym("x")
    hessian, gradient = casadi.hessian(law.function(x, *law.numbers), x)
    at = casadi.Function("derivatives", [x], [gradient, hessian])(share * law.typical)
    first, second = (float(value) for value in at)
    assert np.isfinite([first, second]).all()
    if share < 0.0:
        assert (first, second) == (0.0, 0.0)
    if share > 0.0:
        step = 1e-4 * law.typical
        below, here, above = (law.function(law.typical + k * step, *law.numbers) for k in (-1, 0, 1))
        assert first == pytest.approx((above - below) / (2.0 * step), rel=1e-6)
        curved = (above - 2.0 * here + below) / step**2
        assert second == pytest.approx(curved, rel=1e-4, abs=1e-6 * here / law.typical**2)


def test_no_law_is_left_out() -> None:
    """What presses, by its name, is in the catalogue."""
    from importlib import import_module
    from pathlib import Path

    names = set()
    for file in Path(room.__file__ or "").parent.glob("*.py"):
        if file.stem in (
            "__init__",
            "catalogue",
            "sphere_foot",
            "bristle_friction",
        ):  # tested by themselves, with rates
            continue
        module = import_module(f"geocontact.contact.{file.stem}")
        functions = inspect.getmembers(module, inspect.isfunction)
        names |= {n for n, f in functions if f.__module__ == module.__name__ and not n.startswith("_")}
    pressing = {n for n in names if n.endswith(("_force", "_load")) or (n.endswith("_pressure") and "peak" not in n)}
    assert pressing - {"point_pressure"} == {law.name for law in LAWS}, "the pressure within a patch is not a law"
