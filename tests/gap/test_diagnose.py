"""Whole diagnoses of synthetic cases: nothing, an effect, two, a mistake in the data, something unknown."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from geocontact.analyses.gap.case import proposal_words
from geocontact.analyses.gap.diagnose.answer import verdict_sentences
from geocontact.chain.system import System
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.parameter import Parameter
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.diagnose import diagnose, estimates
from geocontact.gap.remarks import on_bounds
from geocontact.gap.selection.model_comparison import Contender
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import (
    Late,
    Times,
    Tremor,
    diagnosis,
    diagnosis_and_gains,
    diagnosis_of_renamed,
    diagnosis_of_reversed,
    diagnosis_that_names_nothing,
    elbow_case,
    judged_as,
)

pytestmark = pytest.mark.slow

DAMPING = {"damping.b": 15.0, "damping.exponent": 1.0}
FRICTION = {"dry_friction.rate.limit": 1.5, "dry_friction.rate.turning": 0.003}
ALL = ("t01", "t02", "t03", "t04", "t05")


def check(found: Diagnosis) -> None:
    assert sum(found.probabilities.values()) == pytest.approx(1.0)
    assert (found.verdict in ("explained", "partly_explained")) == bool(found.effects)
    for name, gap in found.gap.items():
        assert gap.ci95[0] <= gap.reduction <= gap.ci95[1]
        parts = found.budget[name]
        assert sum(part.share for part in parts.values()) == pytest.approx(1.0)
        assert parts["effects"].share == pytest.approx(1.0 - (gap.rmse_after / gap.rmse_before) ** 2)
        assert all(part.ci95[0] <= part.share <= part.ci95[1] for part in parts.values())


@pytest.fixture(scope="module")
def damped_and_gains(elsewhere: Elsewhere) -> tuple[Diagnosis, list[tuple[bool, float]]]:
    found: tuple[Diagnosis, list[tuple[bool, float]]] = elsewhere(diagnosis_and_gains, "damping", DAMPING, seed=1)
    return found


@pytest.fixture(scope="module")
def damped(damped_and_gains: tuple[Diagnosis, list[tuple[bool, float]]]) -> Diagnosis:
    return damped_and_gains[0]


@pytest.mark.slow
def test_nothing_is_missing_where_nothing_is(elsewhere: Elsewhere) -> None:
    found, gains = elsewhere(diagnosis_and_gains, seed=1)
    check(found)
    assert found.verdict == "no_gap"
    assert gains == [], "nothing to predict trials with"
    assert found.where == ()
    assert found.gap["force"].reduction == 0.0
    assert {"sensor_gain", "preload", "gravity_load"} <= set(found.absorbed)
    told = found.as_dict()["next_experiment"]
    assert set(told["separates"]) <= set(found.absorbed) and "sensor_gain" in told["separates"]
    assert "known load" in told["change"] and told["gain_nats"] > 5.0
    said = verdict_sentences(found, ())
    assert said[-1] == proposal_words(found.next_experiment, "no_gap")
    assert said[-1].startswith(f"next: {told['change']}; that would show ")


def test_damping_is_named_and_measured(damped: Diagnosis) -> None:
    check(damped)
    assert damped.effects == ("damping",)
    assert damped.ambiguity[0] == "damping"
    own = damped.parameters["damping.b"]
    assert own.value == pytest.approx(15.0, rel=0.1)
    assert own.ci95[0] < own.value < own.ci95[1]
    assert own.identifiable
    assert damped.where[0].stage == "constitutive"
    gap = damped.gap["force"]
    assert gap.rmse_after < 0.7 * gap.rmse_before
    assert gap.reduction == pytest.approx(1.0 - gap.rmse_after / gap.rmse_before, abs=0.12)


def test_what_is_there_helps_to_predict_every_trial_from_the_others(
    damped_and_gains: tuple[Diagnosis, list[tuple[bool, float]]],
) -> None:
    gains = damped_and_gains[1]
    assert [held for held, _ in gains] == [False, False, False, True, True]
    assert all(nats > 3.0 for _, nats in gains)


@pytest.mark.slow
def test_where_too_many_remain_reductions_are_those_of_the_likeliest(damped: Diagnosis, elsewhere: Elsewhere) -> None:
    found = elsewhere(diagnosis_that_names_nothing, "damping", DAMPING, seed=1)
    check(found)
    assert found.verdict == "unresolved" and found.ambiguity[0] == "damping"
    assert found.gap == damped.gap and found.where[0].phase == damped.where[0].phase
    assert found.parameters["damping.b"] == damped.parameters["damping.b"]


@pytest.mark.slow
@pytest.mark.long  # with every change: tests/cli/test_gap_diagnose.py, of names, order and units
def test_name_and_order_of_trials_do_not_matter(damped: Diagnosis, elsewhere: Elsewhere) -> None:
    names = dict(zip(ALL, ("zz", "a", "m", "b", "q"), strict=True))
    again = elsewhere(diagnosis_of_renamed, names, "damping", DAMPING, seed=1)
    assert again.effects == damped.effects
    for name, value in damped.probabilities.items():
        assert again.probabilities[name] == pytest.approx(value, abs=1e-9)


@pytest.mark.slow
@pytest.mark.long  # with every change: two effects in test_model_comparison.py
def test_two_effects_are_both_named(elsewhere: Elsewhere) -> None:
    found = elsewhere(diagnosis, "dry_friction.rate", FRICTION, seed=2, change=Late(0.15))
    check(found)
    assert set(found.effects) == {"dry_friction", "time_shift"}


@pytest.mark.slow
@pytest.mark.parametrize("where", [("t05",), pytest.param(ALL, marks=pytest.mark.long)])
def test_a_wrong_unit_is_found_in_all_trials_or_some(where: tuple[str, ...], elsewhere: Elsewhere) -> None:
    found = elsewhere(diagnosis, seed=4, recorded=Times(1000.0, where))
    assert found.effects == ("unit_error",)
    assert found.faults[0].trials == where
    assert found.faults[0].channel == "force"
    assert found.faults[0].factor == pytest.approx(1000.0)
    assert found.where[0].p_value < 0.01  # of the data as they came
    if "t05" in where:
        assert found.gap["force"].reduction > 0.5


@pytest.mark.slow
@pytest.mark.long  # with every change: reversed rotations in test_non_identifiable.py
def test_a_reversed_angle_that_the_offsets_nearly_hide(elsewhere: Elsewhere) -> None:
    where = ("t02", "t05")
    found = elsewhere(diagnosis_of_reversed, where, seed=7)
    check(found)
    assert found.effects == ("sign_flip",)
    assert [(f.channel, f.factor, f.trials) for f in found.faults] == [("beta", -1.0, where)]


@pytest.mark.slow
@pytest.mark.long
def test_a_wrong_unit_that_the_stiffness_takes_for_its_own(elsewhere: Elsewhere) -> None:
    found = elsewhere(diagnosis, seed=4, recorded=Times(4.4482216, ALL))
    check(found)
    assert found.probabilities.get("unit_error", 0.0) > 0.2


@pytest.mark.slow
@pytest.mark.long
def test_a_mistake_beside_an_effect(elsewhere: Elsewhere) -> None:
    found = elsewhere(diagnosis, "damping", DAMPING, seed=1, recorded=Times(1000.0, ("t02",)))
    check(found)
    assert set(found.effects) == {"unit_error", "damping"}
    (fault,) = found.faults
    assert (fault.trials, fault.channel) == (("t02",), "force") and fault.factor == pytest.approx(1000.0)


def test_a_tremor_is_not_explained_by_anything_known(elsewhere: Elsewhere) -> None:
    found = elsewhere(diagnosis, seed=7, change=Tremor(0.6, 6.5))
    check(found)
    assert found.verdict == "unknown"
    assert found.remarks
    assert found.gap["force"].reduction == 0.0


def test_linear_algebra_keeps_to_one_core_meanwhile(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[set[int]] = []

    def threads() -> set[int]:
        return {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"}

    def stop(*_: object) -> None:
        seen.append(threads())
        raise InterruptedError

    monkeypatch.setattr("geocontact.gap.diagnose.admitted", stop)
    case = elbow_case()
    with threadpool_limits(limits=2):
        with pytest.raises(InterruptedError):
            diagnose(case, system_of(case))
        assert threads() == {2}
    assert seen == [{1}]


def test_a_number_on_its_bound_has_the_whole_range_for_an_interval() -> None:
    case = elbow_case(duration=2.0)
    problem = problem_of(case, system_of(case))
    p = next(p for p in problem.system.parameters if p.name == "x")
    n = len(problem.plain.whitened)
    model = replace(problem.plain, values={**problem.plain.values, "x": p.upper}, whitened_jacobian=np.ones((n, 3)))
    found = estimates(judged_as(model), model.values)
    assert found["x"].ci95 == (p.lower, p.upper) and not found["x"].identifiable
    assert found["k"].ci95 != (50.0, 1000.0)


def test_parameters_are_those_of_the_fit_that_is_drawn_and_their_intervals_hold_the_judged_one() -> None:
    case = elbow_case(duration=2.0)
    problem = problem_of(case, system_of(case))
    judged = judged_as(replace(problem.plain, whitened_jacobian=np.diag([0.1, 1e3, 1e3])))
    drawn = {**judged.model.values, "k": judged.model.values["k"] + 40.0}
    near, far = estimates(judged, judged.model.values)["k"], estimates(judged, drawn)["k"]
    assert far.value == drawn["k"] and far.ci95[0] < judged.model.values["k"] < drawn["k"] < far.ci95[1]
    widths = [one.ci95[1] - one.ci95[0] for one in (near, far)]
    assert widths[1] ** 2 - widths[0] ** 2 == pytest.approx((2.0 * 1.959964 * 40.0) ** 2)


def test_what_ends_on_a_bound_is_told() -> None:
    """The shape of a named effect, and a base parameter that the base alone does not drive there."""
    case = elbow_case(duration=2.0)
    problem = problem_of(case, system_of(case))
    (one,) = [each for each in candidates(problem.system) if each.label == "sensor_drift.force"]
    with_it = one.apply(problem.system)
    start = {p.name: p.start for p in with_it.parameters}
    x, bend = (next(p for p in with_it.parameters if p.name == name) for name in ("x", "sensor_drift.force.bend"))

    def contender(system: System, *on_it: Parameter) -> Contender:
        values = {**start, bend.name: 1.0, **{p.name: p.upper for p in on_it}}
        return Contender((one,), judged_as(replace(problem.plain, system=system, values=values)))

    def told(*ended: Parameter, base: tuple[Parameter, ...] = ()) -> tuple[str, ...]:
        both = contender(with_it, *ended), contender(problem.system, *base)
        return on_bounds(*both, *(one.judged.model.values for one in both))

    assert told() == ()
    assert told(bend) == (f"the shape {bend.name} ends on its bound, 10 -",)
    assert told(x) == ("with sensor_drift the base parameter x ends on its bound, 0.1 m",)
    assert told(x, base=(x,)) == ()
