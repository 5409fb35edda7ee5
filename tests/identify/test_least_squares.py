"""Least squares over trials: closed form of a linear model, bounds, starts, missing cells."""

import numpy as np
import pytest

from geocontact.data.parameter import Parameter
from geocontact.identify.optimise.least_squares import NO_VALUE, fit

TIMES = [np.linspace(0, 1, 30), np.linspace(0, 2, 50)]


def line(values):
    """Two channels: a + b t, and 3 a."""
    return [np.column_stack([values["a"] + values["b"] * t, 3.0 * values["a"] + 0.0 * t]) for t in TIMES]


def given(lower=-10.0, upper=10.0, start=1.0):
    return (Parameter("a", "m", start, lower, upper), Parameter("b", "m/s", 0.0, -10.0, 10.0))


def noisy(seed=0):
    rng = np.random.default_rng(seed)
    return [y + rng.normal(size=y.shape) * [0.1, 0.4] for y in line({"a": 2.0, "b": -1.0})]


FLOOR = np.array([0.1, 0.4])


def test_linear_model_is_solved_as_the_normal_equations_do():
    measured = noisy()
    found = fit(line, measured, given(), FLOOR)
    rows = [np.concatenate([y[:, 0] / 0.1, y[:, 1] / 0.4]) for y in measured]
    design = []
    for t in TIMES:
        one, none = np.ones_like(t), np.zeros_like(t)
        design += [np.column_stack([one, t]) / 0.1, np.column_stack([3.0 * one, none]) / 0.4]
    expected, squares = np.linalg.lstsq(np.vstack(design), np.concatenate(rows), rcond=None)[:2]
    assert [found.values["a"], found.values["b"]] == pytest.approx(expected, rel=1e-7)
    assert found.cost == pytest.approx(0.5 * squares[0], rel=1e-9)
    assert found.names == ("a", "b") and found.converged


def test_derivatives_and_residuals_are_per_trial():
    measured = noisy()
    found = fit(line, measured, given(), FLOOR)
    for k, t in enumerate(TIMES):
        np.testing.assert_allclose(found.jacobian[k][:, 0], np.column_stack([np.ones_like(t), t]), atol=1e-7)
        np.testing.assert_allclose(found.residuals[k], measured[k] - line(found.values)[k])


def test_bounds_hold():
    found = fit(line, noisy(), given(upper=1.5), FLOOR)
    assert found.values["a"] == pytest.approx(1.5, abs=1e-6) and found.values["a"] <= 1.5


def test_fixed_parameters_are_left_alone():
    a = Parameter("a", "m", 2.0, fixed=True)
    found = fit(lambda v: line({"a": 2.0, **v}), noisy(), (a, given()[1]), FLOOR)
    assert set(found.values) == {"b"} and found.values["b"] == pytest.approx(-1.0, abs=0.1)
    none = fit(lambda v: line({"a": 2.0, "b": -1.0}), noisy(), (a,), FLOOR)
    assert none.values == {} and none.cost > 0.0 and none.jacobian[0].shape == (30, 2, 0)


def test_best_of_several_starts_wins():
    """A wave whose phase has a wrong basin."""
    t = TIMES[0]

    def wave(values):
        return [np.sin(12.0 * t + values["phase"])[:, None]]

    p = (Parameter("phase", "rad", 3.5, -4.0, 4.0),)
    lost = fit(wave, wave({"phase": 0.0}), p, np.array([0.1]))
    found = fit(wave, wave({"phase": 0.0}), p, np.array([0.1]), starts=({}, {"phase": 1.0}, {"phase": 99.0}))
    assert lost.cost > 100.0
    assert found.cost < 1e-6 and abs(found.values["phase"]) < 1e-5
    assert len(found.costs) == 3 and min(found.costs) == found.cost


def test_missing_cells_do_not_count_and_missing_predictions_cost():
    measured = noisy()
    measured[0][5:9, 0] = np.nan
    measured[1][:, 1] = np.nan
    found = fit(line, measured, given(), FLOOR)
    assert np.isnan(found.residuals[0][5:9, 0]).all() and np.isfinite(found.residuals[0][9:, 0]).all()

    def without(values):
        out = line(values)
        out[0][:3] = np.nan
        return out

    dear = fit(without, [np.full((30, 2), np.nan), np.full((50, 2), np.nan)], given(), FLOOR)
    assert dear.cost == 0.0
    some = fit(
        without, [np.vstack([np.ones((3, 2)), np.full((27, 2), np.nan)]), np.full((50, 2), np.nan)], given(), FLOOR
    )
    assert some.cost == pytest.approx(0.5 * 6 * NO_VALUE**2)
