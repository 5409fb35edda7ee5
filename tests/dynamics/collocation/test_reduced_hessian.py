"""How sharply a cost tells its parameters, against a linear-quadratic problem in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from casadi import SX

from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.reduced_hessian import inverse_reduced_hessian
from geocontact.dynamics.collocation.solve import SolverOptions, solve
from tests.dynamics.collocation.closed_problems import system, trial

R, T = 0.3, 1.5


def drift(prior: float = 0.0, held: bool = False) -> ControlProblem:
    """x' = p + u from 0, least integral of (x - d)^2 + R u^2, and a second parameter that only its prior knows.

    With r x'' = x the least cost is p^2 (R T - R^1.5 tanh(T / sqrt R)) for d = 0; d moves the minimum only.
    """
    x, u, p = SX.sym("x"), SX.sym("u"), SX.sym("p", 2)
    one = system(x, u, p[0] + u, cost=(x - 0.4) ** 2 + R * u**2, p=p, prior=prior * p[1] ** 2)
    wide = np.array([5.0, 0.0 if held else 5.0])
    return ControlProblem(one, (trial([0.0], [np.nan], (T, T), [0.0]),), (-wide, wide), np.zeros(2))


def test_curvature_is_that_of_the_closed_form() -> None:
    problem = drift(prior=7.0)
    found = solve(problem, SolverOptions("radau", 4, 12, 1e-12))
    inverse = inverse_reduced_hessian(problem, found)
    curvature = 2.0 * (R * T - R**1.5 * np.tanh(T / np.sqrt(R)))
    np.testing.assert_allclose(inverse, np.diag([1.0 / curvature, 1.0 / 14.0]), rtol=1e-7, atol=1e-9)


def test_held_parameters_do_not_count_and_untold_ones_are_refused() -> None:
    fixed, untold = drift(held=True), drift()
    options = SolverOptions("radau", 3, 6)
    found = solve(fixed, options)
    inverse = inverse_reduced_hessian(fixed, found)
    assert inverse[0, 0] > 0.0 and (inverse[1] == 0.0).all()
    both = solve(untold, options)
    assert inverse_reduced_hessian(untold, both, (False, True))[0, 0] == pytest.approx(inverse[0, 0], rel=1e-9)
    with pytest.raises(ValueError, match="not told"):
        inverse_reduced_hessian(untold, both)
