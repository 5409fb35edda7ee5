"""The stand-in for anything unknown takes bumps that are worth their price, and none from noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.selection.evidence import judged
from geocontact.gap.selection.model_comparison import base_contender, discrepancy_basis
from geocontact.gap.selection.surrogate import chosen, surrogate
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import Bump, elbow_case, stairs, stood_in


def test_a_bump_is_found_among_many_columns() -> None:
    rng = np.random.default_rng(0)
    columns, known = rng.standard_normal((300, 40)), rng.standard_normal((300, 3))
    residual = rng.standard_normal(300) + 0.8 * columns[:, 7] + 5.0 * known[:, 0]
    found = chosen(residual, columns, known, 200, 1.0)
    assert found.columns == [7]
    assert found.by_all.weights[0] == pytest.approx(0.8, abs=0.2)
    assert 0.0 < found.calibration < found.gain
    assert found.price > 1.0


def test_nothing_is_found_in_noise() -> None:
    rng = np.random.default_rng(1)
    nothing = np.zeros((300, 1))
    draws = [(rng.standard_normal(300), rng.standard_normal((300, 40))) for _ in range(40)]
    hits = [chosen(residual, columns, nothing, 200, 1.0).columns for residual, columns in draws]
    assert sum(map(bool, hits)) <= 2


def test_fitted_parameters_make_room() -> None:
    rng = np.random.default_rng(4)
    known, column = rng.standard_normal((300, 2)), rng.standard_normal((300, 1))
    found = chosen(2.0 * column[:, 0] + 3.0 * known[:, 1], column, known, 200, 1.0)
    assert found.by_all.shift == pytest.approx([0.0, 3.0], abs=0.05)


def test_what_fitted_parameters_explain_is_not_paid_for() -> None:
    rng = np.random.default_rng(2)
    known = rng.standard_normal((300, 2))
    assert chosen(30.0 * known[:, 0], known[:, :1], known, 200, 1.0).columns == []


def test_a_push_in_the_middle_of_every_trial(elsewhere: Elsewhere) -> None:
    found = elsewhere(stood_in, Bump(1.5, 8.0, 0.8))
    assert found.nats > 20.0
    assert found.predicted[0][200, 0] == pytest.approx(1.5, rel=0.5)


def test_a_short_push_that_noise_of_the_input_would_explain_away(elsewhere: Elsewhere) -> None:
    found = elsewhere(stood_in, Bump(1.2, 8.0, 0.12))
    assert found.nats > 20.0
    assert found.family == "time within the trial"


def test_coarse_steps_of_the_recorder_are_nothing_to_explain(elsewhere: Elsewhere) -> None:
    """Rounding is noise of variance q²/12, whatever regular pattern it leaves over the prediction."""
    assert elsewhere(stood_in, stairs).nats < 5.0


def test_the_stand_in_finds_nothing_where_nothing_is(elsewhere: Elsewhere) -> None:
    assert elsewhere(stood_in, None).nats < 3.0


def test_samples_without_an_output_take_no_part() -> None:
    """A push, of which half of the samples were measured, in stretches of a second: as in a thinned trial."""
    case = elbow_case(seed=5, change=Bump(1.5, 8.0, 0.8))
    for trial in (*case.calibration, *case.evaluation):
        trial.signals.values[trial.time % 2.0 > 1.0, trial.signals.channels.index("force")] = np.nan
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    found = surrogate(problem, base)
    damper = next(one for one in candidates(problem.system) if one.label == "damping")
    values = {**base.model.values, **{p.name: 0.5 * p.upper for p in damper.parameters}}
    bent = discrepancy_basis(problem, (damper,), replace(base.model, values=values))
    assert found.nats > 10.0
    for trial, parts in zip(
        (*case.calibration, *case.evaluation), zip(found.predicted, bent, strict=True), strict=True
    ):
        measured = np.isfinite(trial.column("force"))
        assert 0.4 < measured.mean() < 0.6
        for part in parts:
            assert len(part) == len(trial) and part[measured].any() and not part[~measured].any()


def test_better_noise_alone_is_no_gain() -> None:
    """Where the search for noise ended too early, noise estimated anew makes the same model more probable."""
    case = elbow_case(seed=1)
    problem = problem_of(case, system_of(case))
    model = base_contender(problem).judged
    loud = replace(model.noise.levels, white=3.0 * model.noise.levels.white)
    whiteners = tuple(layout.whitener(loud) for layout in problem.layouts)
    poor = judged(problem, model.model, replace(model.noise, levels=loud, whiteners=whiteners), model.discrepancy_basis)
    assert poor.nats < model.nats - 20.0
    assert surrogate(problem, poor).nats < 3.0
