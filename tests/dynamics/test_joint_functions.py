"""Functions of coordinates in symbols are the ones in numbers, kinks and ends included."""

from __future__ import annotations

import casadi
import numpy as np
import pytest

from geocontact.data.multibody.joint import Affine, JointFunction
from geocontact.dynamics.symbols import value_of
from geocontact.io.opensim.osim_functions import piecewise_linear, polynomial, simm_spline

X = np.array([-1.0, -0.4, 0.1, 0.5, 1.2])
Y = np.array([0.2, -0.1, 0.3, 0.25, -0.4])
FUNCTIONS: dict[str, JointFunction] = {
    "constant": Affine(np.zeros(1), 0.3),
    "affine": Affine(np.array([-1.5]), 0.2),
    "polynomial": polynomial(np.array([0.3, -0.2, 0.5, 0.1])),
    "spline": simm_spline(X, Y),
    "scaled spline": simm_spline(X, Y).scaled(-1.7),
    "lines": piecewise_linear(X, Y),
    "two points": simm_spline(X[:2], Y[:2]),
}


@pytest.mark.parametrize("function", FUNCTIONS.values(), ids=FUNCTIONS.keys())
def test_symbols_are_worth_the_numbers(function: JointFunction) -> None:
    q = casadi.SX.sym("q", 1)
    at = casadi.Function("f", [q], [value_of(function, q)])
    where = np.concatenate([np.linspace(-2.0, 2.0, 41), X, X + 1e-9, X - 1e-9])
    found = np.array([float(at(value)) for value in where])
    np.testing.assert_allclose(found, function(where[:, None]), atol=1e-14)


def test_an_affine_function_of_several_coordinates() -> None:
    function = Affine(np.array([0.5, -2.0, 3.0]), 0.7)
    q = casadi.SX.sym("q", 3)
    where = np.random.default_rng(0).normal(size=(5, 3))
    at = casadi.Function("f", [q], [value_of(function, q)])
    np.testing.assert_allclose([float(at(w)) for w in where], function(where), atol=1e-15)


def test_a_spline_bends_smoothly_in_symbols() -> None:
    q = casadi.SX.sym("q", 1)
    slope = casadi.Function("s", [q], [casadi.jacobian(value_of(simm_spline(X, Y), q), q)])
    for knot in X:
        assert float(slope(knot - 1e-9)) == pytest.approx(float(slope(knot + 1e-9)), abs=1e-7)
