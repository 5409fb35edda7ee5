"""Every term of what is made least of an elbow, of areas and forces, and of any trials, beside loops over numbers."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.axis_misalignment.compensation import TOTAL, DisplacementScale
from geocontact.axis_misalignment.law import NAMES, ElbowLaw
from geocontact.axis_misalignment.least_squares import ElbowProblem, Prior
from geocontact.data.parameter import Parameter
from geocontact.identify.optimise.least_squares import NO_VALUE, divided, fit
from geocontact.identify.optimise.quasi_newton import search

FLOOR = np.array([0.2, 5.0, 30.0])


def trials() -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Predicted and measured, of different lengths, some not measured and some without a value."""
    rng = np.random.default_rng(7)
    predicted, measured = ([rng.normal(size=(count, 3)) * FLOOR for count in (4, 6)] for _ in range(2))
    measured[0][1, 2] = measured[1][3, 0] = np.nan
    predicted[1][2, 1] = predicted[0][1, 2] = np.nan
    return predicted, measured


def by_hand(predicted: list[np.ndarray], measured: list[np.ndarray]) -> float:
    total = 0.0
    for p, m in zip(predicted, measured, strict=True):
        for t in range(len(m)):
            for c in range(3):
                if np.isfinite(m[t, c]):
                    total += NO_VALUE**2 if np.isnan(p[t, c]) else ((p[t, c] - m[t, c]) / FLOOR[c]) ** 2
    return total


def test_trials_by_hand() -> None:
    """Half the sum of squares over trials and channels, by least squares and by quasi-Newton."""
    predicted, measured = trials()
    held = Parameter("k", "-", 1.0, 0.0, 2.0, fixed=True)
    for by in (fit, search):
        found = by(lambda _: predicted, measured, [held], FLOOR)
        assert found.cost == pytest.approx(0.5 * by_hand(predicted, measured), rel=1e-13)
    free = Parameter("k", "-", 0.9, 0.5, 2.0)
    for by in (fit, search):
        found = by(lambda v: [v["k"] * p for p in predicted], measured, [free], FLOOR)
        again = [found.values["k"] * p for p in predicted]
        assert found.cost == pytest.approx(0.5 * by_hand(again, measured), rel=1e-12)
        if by is search:
            assert found.costs[0] == pytest.approx(found.cost, rel=1e-5)


@pytest.mark.parametrize(
    ("predicted", "measured", "floor"),
    [((4, 3), (4, 3), 2), ((4, 3), (4, 3), 1), ((4, 1), (4, 3), 3), ((1, 3), (4, 3), 3), ((4, 3), (4, 1), 3)],
)
def test_sizes_that_do_not_fit_are_refused(predicted: tuple[int, int], measured: tuple[int, int], floor: int) -> None:
    """Also where the package's shapes are not checked and NumPy would broadcast."""
    bare = getattr(divided, "__wrapped__", divided)
    with pytest.raises(ValueError, match="channels"):
        bare(np.zeros(predicted), np.zeros(measured), np.ones(floor))


def elbow(scale: DisplacementScale | None) -> ElbowProblem:
    rng = np.random.default_rng(8)
    law = ElbowLaw(rng.uniform(0.2, 2.0, 9), rng.normal(size=9), 100.0 * rng.normal(size=9))
    theta = {"k": 900.0, "x": 0.01, "y": -0.02, "l": 0.2, "z": 0.05, "b": 3.0, "s": 1e-4, "c": 0.0}
    room = {name: 0.5 * abs(value) + 1e-6 for name, value in theta.items()}
    parameters = [
        Parameter(name, "-", value, value - room[name], value + room[name], fixed=name in ("c", "b"))
        for name, value in theta.items()
    ]
    priors = {"l": Prior(0.19, 0.02), "x": Prior(0.0, 0.005), "k": Prior(1000.0, 50.0)}
    weight = rng.uniform(0.1, 4.0, 9)
    return ElbowProblem(rng.normal(0.0, 10.0, 9), law, weight, tuple(parameters), priors, scale)


def test_elbow_by_hand() -> None:
    """Cells by their weights, the scale by its error, three priors out of order; derivatives by differences."""
    rng = np.random.default_rng(9)
    at = ElbowLaw(rng.uniform(0.2, 2.0, 5), np.zeros(5), np.zeros(5))
    problem = elbow(DisplacementScale(at, rng.normal(size=5), 1.02, 0.03, 4, dict(TOTAL)))
    values = np.array([950.0, 0.012, -0.018, 0.21, 0.055, 1.2e-4])
    assert problem.names == ("k", "x", "y", "l", "z", "s")
    theta = np.array([950.0, 0.012, -0.018, 0.21, 0.055, 3.0, 1.2e-4, 0.0])
    force = problem.law.force(theta)
    total = sum(((force[n] - problem.force[n]) * problem.weight[n]) ** 2 for n in range(9))
    still = theta.copy()
    for place, value in TOTAL.items():
        still[place] = value
    assert problem.scale is not None
    slope = sum(problem.scale.share[n] * at.force(still)[n] for n in range(5))
    total += ((slope - 1.02) / 0.03) ** 2
    for name, prior in problem.priors.items():
        total += ((theta[NAMES.index(name)] - prior.mean) / prior.sd) ** 2
    found = problem.residual(values)
    assert len(found) == 9 + 1 + 3 and float(found @ found) == pytest.approx(total, rel=1e-12)
    for k, value in enumerate(values):
        step = np.zeros(6)
        step[k] = 1e-5 * abs(value)
        by = (problem.residual(values + step) - problem.residual(values - step)) / (2.0 * step[k])
        np.testing.assert_allclose(problem.jacobian(values)[:, k], by, rtol=1e-5, atol=1e-6 * np.abs(by).max())
