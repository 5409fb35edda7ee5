"""How far the gap shrinks, and between what and what. The cases are synthetic."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

from geocontact.effects.catalogue import candidates
from geocontact.gap.case.plain_fit import plain_fit
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.whitening import sensitivity
from geocontact.gap.reduction.error_reduction import (
    LONE,
    WIDE,
    between,
    error_reduction,
    error_reduction_of,
    relative_scatter,
)
from geocontact.gap.reduction.raw_input_errors import directions, passed_on, raw_input_errors, unseen
from geocontact.gap.selection.evidence import Judged
from geocontact.gap.selection.model_comparison import base_contender, singles
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case


@pytest.fixture(scope="module")
def problem() -> Problem:
    case = elbow_case("damping", {"damping.b": 22.0, "damping.exponent": 1.0}, seed=3)
    return problem_of(case, system_of(case))


def named(problem: Problem, name: str) -> Judged:
    """The base model with one candidate."""
    one = next(c for c in candidates(problem.system) if c.name == name)
    return singles(problem, base_contender(problem), (one,))[0].judged


def test_a_narrow_interval_is_one_of_the_logarithm() -> None:
    low, middle, high = between(4.0, 1.0)
    assert middle == 4.0
    assert np.log(high / middle) == pytest.approx(0.25) == np.log(middle / low)


def test_a_wide_one_goes_on_in_proportion_without_a_jump() -> None:
    below, above = between(2.0, (WIDE - 1e-9) * 2.0), between(2.0, (WIDE + 1e-9) * 2.0)
    assert below == pytest.approx(above)
    low, _, high = between(2.0, 8.0)
    assert low < 0.0 and high - 2.0 == pytest.approx(2.0 * (between(2.0, 4.0)[2] - 2.0))


def test_what_stays_widens_the_logarithm_and_takes_nothing_below_0() -> None:
    """Of 80 ± 20 % over something known to e^±1.5: half-widths of 0.2 and 1.5 add in squares."""
    low, middle, high = between(80.0, 16.0, 1.5)
    assert np.log([middle / low, high / middle]) == pytest.approx([np.hypot(0.2, 1.5)] * 2)
    below, above = between(2.0, (WIDE - 1e-9) * 2.0, 0.7), between(2.0, (WIDE + 1e-9) * 2.0, 0.7)
    assert below == pytest.approx(above)
    assert between(2.0, 8.0, 0.7)[0] < between(2.0, 8.0)[0] < 0.0


def test_scatter_is_pooled_over_trials_that_are_fitted_and_held_out() -> None:
    """1 and 3 about 2, 30 and 50 about 40: (2 × 0.5² + 2 × 0.25²)/2."""
    seen = [(False, 1.0), (False, 3.0), (True, 30.0), (True, 50.0)]
    assert relative_scatter(seen) == pytest.approx(0.3125)
    assert relative_scatter([(False, 1.0), (True, 9.0)]) == pytest.approx(LONE**2)
    assert relative_scatter([(False, 1.0), (False, 3.0), (True, 9.0)]) == pytest.approx(0.5)


@pytest.mark.parametrize("ratio", [0.0, -0.2])
def test_what_is_less_than_nothing_has_one_too(ratio: float) -> None:
    low, middle, high = between(ratio, 0.3)
    assert low < middle == ratio < high


def test_who_passes_twice_the_noise_on_errs_the_more(problem: Problem) -> None:
    """a = 2 b makes 2 E[a (b - a)] = -4 E[b²], with b what the noise does to the base model's prediction."""
    base, count = base_contender(problem).judged, len(problem.calibration.trials)
    system, held_out = problem.system.as_measured(), problem.recorded.trials[count:]
    twice = {**base.model.values, "k": 2.0 * base.model.values["k"]}
    outputs = problem.recorded.outputs[count:]
    pair = [
        (system, own, [o - system.simulate(t, own) for o, t in zip(outputs, held_out, strict=True)])
        for own in (base.model.values, twice)
    ]
    level = float(base.noise.levels.inputs[0])
    seen = [sensitivity(system, t, base.model.values, ()).to_value[:, 0, 0] for t in held_out]
    expected = -4.0 * level**2 * float(np.mean(np.concatenate(seen) ** 2))
    assert passed_on(problem, base, pair) == pytest.approx([expected], rel=0.3)
    assert passed_on(problem, base, [pair[0], pair[0]]) == pytest.approx([0.0])


@pytest.mark.slow
def test_what_an_effect_does_otherwise_is_part_of_the_best_fit() -> None:
    """A drift that is not straight: the straight candidate, as it is and bent."""
    case = elbow_case(seed=3, change=lambda _, time, force: force + 0.008 * time**2)
    problem = problem_of(case, system_of(case))
    found = named(problem, "sensor_drift")
    columns = [j.shape[-1] + b.shape[-1] for j, b in zip(found.model.jacobian, found.discrepancy_basis, strict=True)]
    assert [d.shape[-1] for d in directions(found)] == columns and found.discrepancy_basis[0].shape[-1] > 0
    straight = [b[..., :0] for b in found.discrepancy_basis]
    plain = replace(found, discrepancy_basis=straight, whitened_basis=found.whitened_basis[:, :0])
    bent_left, plain_left = (raw_input_errors(problem, problem, each, None).left[0][0] for each in (found, plain))
    assert bent_left < 0.9 * plain_left


def test_a_reduction_is_stated_with_its_interval(problem: Problem) -> None:
    found = error_reduction(problem, problem, named(problem, "damping"), True)["force"]
    assert 0.0 < found.low < found.reduction < found.high < 1.0
    assert found.reduction == pytest.approx(1.0 - found.rmse_after / found.rmse_before, abs=0.15)
    nothing = error_reduction(problem, problem, base_contender(problem).judged, False)["force"]
    assert (nothing.low, nothing.reduction, nothing.high) == (0.0, 0.0, 0.0)


def test_each_trial_is_predicted_by_a_fit_to_the_others(problem: Problem) -> None:
    """Beside fits to the others by another search."""
    system, count = problem.system.as_measured(), len(problem.calibration.trials)
    recorded = problem.recorded
    first = replace(recorded, trials=recorded.trials[:count], outputs=recorded.outputs[:count])
    fitted = plain_fit(system, first, problem.floor, [problem.plain.values])
    names, start = list(fitted.values), np.array(list(fitted.values.values()))
    found = unseen(system, first, problem.floor, fitted.values, fitted.residuals)

    def off(i: int, x: np.ndarray) -> np.ndarray:
        told = system.simulate(first.trials[i], dict(zip(names, x * start, strict=True)))
        return np.asarray(first.outputs[i] - told)[:, 0]

    for i in range(count):
        others = [j for j in range(count) if j != i]
        best = least_squares(
            lambda x, some=others: np.concatenate([off(j, x) for j in some]) / problem.floor[0], np.ones(len(names))
        )
        exact = off(i, best.x)
        assert np.sqrt(np.mean((found[i][:, 0] - exact) ** 2)) < 0.1 * np.sqrt(np.mean(exact**2))
        assert np.mean(exact**2) > np.mean(fitted.residuals[i] ** 2)


def test_the_interval_has_what_all_trials_show(problem: Problem) -> None:
    """A fit without one of the calibration trials that predicts it much worse than the base model does."""
    judged = named(problem, "damping")
    errors = raw_input_errors(problem, problem, judged, None)
    usual = error_reduction_of(errors, problem, judged, True, None)["force"]
    count = len(problem.calibration.trials)
    worse = [3.0 * each if i < count else each for i, each in enumerate(errors.unseen_after)]
    wider = error_reduction_of(replace(errors, unseen_after=worse), problem, judged, True, None)["force"]
    squares = [np.mean(np.concatenate(parts) ** 2) for parts in (errors.unseen, worse)]
    assert wider.low == pytest.approx(1.0 - float(np.sqrt(squares[1] / squares[0])))
    assert wider.low < usual.low and wider.high == usual.high


def test_a_spread_about_two_means_has_two_degrees_less(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    """Student's quantile of four trials, two on each side, is that of 2 degrees of freedom: 4.30, not 3.18."""
    judged = named(problem, "damping")
    errors = replace(raw_input_errors(problem, problem, judged, None), told_by=4)
    widths: list[float] = []

    def seen(ratio: float, spread: float, divisor: float = 0.0) -> tuple[float, float, float]:
        widths.append(spread)
        return between(ratio, spread, divisor)

    monkeypatch.setattr("geocontact.gap.reduction.error_reduction._gone", lambda *_: (1.0, 0.1))
    monkeypatch.setattr("geocontact.gap.reduction.error_reduction.between", seen)
    error_reduction_of(errors, problem, judged, True, None)
    assert widths[0] * errors.left[0][0] == pytest.approx(4.3027 * 0.1, rel=1e-4)


def test_what_held_out_trials_show_is_inside_the_interval(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the best fit says otherwise, as it does where something else is missing as well."""
    judged = named(problem, "damping")
    monkeypatch.setattr("geocontact.gap.reduction.error_reduction._gone", lambda *_: (1e-9, 1e-9))
    found = error_reduction(problem, problem, judged, True)["force"]
    errors = raw_input_errors(problem, problem, judged, None)
    whole = [np.mean(np.concatenate(parts) ** 2) for parts in (errors.unseen, errors.unseen_after)]
    shown = [1.0 - found.rmse_after / found.rmse_before, 1.0 - float(np.sqrt(whole[1] / whole[0]))]
    assert found.reduction < 0.1 and found.high == pytest.approx(max(shown))
