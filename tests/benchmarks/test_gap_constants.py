"""Constants in question: found where they stand, put where they are used, and counted for what they move."""

from __future__ import annotations

import ast
import inspect
import os
from argparse import Namespace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from benchmarks.gap import constants as gap_constants
from benchmarks.gap import later_constants as gap_told_constants
from benchmarks.gap.constants import ROOMS, choices, figures, searched
from benchmarks.gap.constants_of import _numbers, bare, constants, in_use, put, tables, with_others
from benchmarks.gap.later_constants import attributed, changes, inside, row, told
from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.effects.catalogue import candidates
from geocontact.gap import levels
from geocontact.gap import remarks as partial_answer
from geocontact.gap.case import plain_fit, refit
from geocontact.gap.selection import residual_anomalies as clipping
from geocontact.gap.selection import surrogate, verdict
from tests.house.test_gap_theory import ROWS

WHOLE = ("gap", "identify")


def test_a_number_is_another_one_wherever_it_was_imported() -> None:
    found = {one.label: one for one in constants(ROOMS)}
    sure = found["gap.levels.SURE"]
    assert sure.value == levels.SURE and "gap.selection.residual_anomalies.NEXT" in found
    assert found["identify.optimise.bounded_gauss_newton.BROKEN"].value == 0.25  # one of two that a line names
    assert "gap.selection.surrogate.ALONG" not in found
    assert "gap.selection.surrogate.ALONG" in {one.label for one in tables(ROOMS)}
    before, other = sure.value, clipping.NEXT
    try:
        put({sure: sure.times(2.0)})
        used = [levels.SURE, partial_answer.SURE, verdict.SURE, clipping.NEXT]
        assert used == [*[2.0 * before] * 3, other]
    finally:
        put({sure: before})
    assert used[0] != partial_answer.SURE
    assert found["gap.selection.residual_anomalies.NEXT"].times(0.01) == 1


def test_a_default_of_an_argument_is_another_one_too() -> None:
    rounds = next(one for one in constants(ROOMS) if one.label == "gap.case.refit.ROUNDS")

    def told() -> list[int]:
        return [inspect.signature(each).parameters["rounds"].default for each in (refit.refit, plain_fit.plain_fit)]

    before = told()
    try:
        put({rounds: rounds.times(0.5)})
        after = told()
    finally:
        put({rounds: rounds.value})
    assert before == told() == [rounds.value // 2, rounds.value]
    assert after == [rounds.value // 4, rounds.value // 2]


NONE, DAMPED = {"kind": "none", "effects": []}, {"kind": "single", "effects": ["damping"]}
QUIET = {"verdict": "no_gap", "first": "", "probabilities": {"none": 1.0}}
RIGHT = {"verdict": "explained", "first": "damping", "probabilities": {"damping": 0.5, "none": 0.5}}


def test_answers_are_counted_by_what_they_were_and_are() -> None:
    alarm = {"verdict": "unknown", "first": "slip", "probabilities": {"none": float(np.exp(-2.0))}}
    told = figures({"a": NONE, "b": DAMPED}, {"a": QUIET, "b": RIGHT}, {"a": alarm, "b": RIGHT | {"first": "slip"}})
    assert told["moved"] == ["a", "b"]
    half = pytest.approx(np.log(0.5) / 2)
    assert told["before"] == {"false_alarms": 0, "first_right": 1, "failed": 0, "nats": half}
    later = pytest.approx((np.log(0.5) - 2.0) / 2)
    assert told["after"] == {"false_alarms": 1, "first_right": 0, "failed": 0, "nats": later}


def test_a_diagnosis_that_fails_is_no_false_alarm(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(folder: Path) -> dict:
        raise ValueError(folder.name)

    monkeypatch.setattr(gap_constants, "answer_of", broken)
    truths, right = {"a": NONE, "b": DAMPED}, {"a": QUIET, "b": RIGHT}
    failed = gap_constants.answers({name: Path(name) for name in truths})
    told = figures(truths, right, failed)
    assert told["before"] | {"nats": 0.0} == {"false_alarms": 0, "first_right": 1, "failed": 0, "nats": 0.0}
    assert told["after"] == {"false_alarms": 0, "first_right": 0, "failed": 2, "nats": None}
    assert len(told["moved"]) == 2
    assert figures(truths, right, {})["after"] == told["after"]  # a process that was killed has told nothing


def test_nats_are_of_cases_that_are_answered_before_and_after() -> None:
    ended = {"verdict": "failed: ValueError", "first": "", "probabilities": {}}
    told = figures({"a": NONE, "b": DAMPED}, {"a": QUIET, "b": RIGHT}, {"a": QUIET, "b": ended})
    assert told["before"]["nats"] == told["after"]["nats"] == 0.0 and told["after"]["failed"] == 1


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the process is forked")
def test_constants_are_others_in_a_process_of_its_own_only() -> None:
    sure = next(one for one in constants(ROOMS) if one.label == "gap.levels.SURE")
    assert with_others({sure: 1.5}, lambda: (levels.SURE, verdict.SURE)) == (1.5, 1.5)
    assert levels.SURE == verdict.SURE == sure.value
    assert with_others({}, lambda: os._exit(9)) is None


def test_cases_are_drawn_before_anything_is_changed(tmp_path: Path) -> None:
    asked = Namespace(systems=["elbow"], cases=2, kinds=["none", "single"], seed=352612, laboratories=["home"])
    cases, truths = gap_constants.drawn_cases(asked, tmp_path)
    assert list(cases) == list(truths) == ["elbow none 0 home", "elbow single 0 home"]
    assert truths["elbow none 0 home"]["effects"] == [] and truths["elbow single 0 home"]["effects"]
    assert all((folder / "case.toml").exists() for folder in cases.values())


def test_parts_that_change_are_told_with_their_largest_change() -> None:
    one = {"verdict": "no_gap", "gap": {"M": {"ci95": [0.1, 0.2]}}, "where": [1.0, 2.0], "seen": True}
    two = {"verdict": "no_gap", "gap": {"M": {"ci95": [0.1, 0.4]}}, "where": [1.0], "seen": True}
    assert changes(one, one) == {} and changes(one, two) == {"gap": 0.5, "where": 1.0}
    assert changes(one, {"failed": "ValueError"}) == dict.fromkeys(["failed", *one], 1.0)


def test_reductions_are_counted_where_an_effect_is_named() -> None:
    truths = {name: {"reduction": {"M": 0.5}} for name in "abc"}
    said = {
        "a": {"effects": ["damping"], "gap": {"M": {"ci95": [0.4, 0.6]}}},
        "b": {"effects": ["damping"], "gap": {"M": {"ci95": [0.6, 0.7]}}},
        "c": {"effects": [], "gap": {"M": {"ci95": [0.4, 0.6]}}},
    }
    assert inside(truths, said) == (1, 2)
    moved = row(truths, said, said | {"b": {"effects": ["damping"], "gap": {"M": {"ci95": [0.3, 0.7]}}}})
    assert moved == {"moved": 1, "parts": {"gap": 0.5}, "inside": [2, 2]}
    assert row(truths, said, None)["parts"] == {"failed": 1.0}


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="the process is forked")
def test_a_constant_of_the_interval_moves_the_gap_and_no_verdict(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Namespace(systems=["elbow"], cases=1, kinds=["single"], seed=5, laboratories=["home"])
    cases, truths = gap_constants.drawn_cases(asked, tmp_path)
    ((name, folder),) = cases.items()

    def planted(system: System) -> tuple[Candidate, ...]:
        return tuple(one for one in candidates(system) if one.name in truths[name]["effects"])

    monkeypatch.setattr(gap_told_constants, "candidates", planted)
    form = next(one for one in constants(WHOLE) if one.label == "gap.reduction.error_reduction.FORM")
    work = partial(told, {name: attributed(folder)})
    before, same, wider = (with_others(changed, work) for changed in ({}, {}, {form: form.times(10.0)}))
    assert changes(before[name], same[name]) == {} and set(changes(before[name], wider[name])) == {"gap"}


def test_a_group_is_halved_down_to_what_moves_an_answer() -> None:
    named, asked = constants(["gap.levels"])[:10], []

    def tried(group: list, factor: float) -> dict:
        asked.append([one.name for one in group])
        return {"moved": ["a"] if any(one.name == "SLIGHT" for one in group) else []}

    searched(named, 2.0, tried)
    assert [names for names in asked if len(names) == 1] == [["SLIGHT"]] and len(asked) < len(named)


def test_choices_do_not_become_more_again() -> None:
    """Of a verdict, and of all that a diagnosis imports of gap and identify."""
    assert len(constants(ROOMS)) <= 90
    assert len(bare(ROOMS)) <= 3
    assert len(tables(ROOMS)) <= 18
    assert len(constants(WHOLE)) <= 126
    assert len(bare(WHOLE)) <= 6
    assert len(tables(WHOLE)) <= 20


def test_every_constant_of_a_diagnosis_has_a_row() -> None:
    rows = {f"{module}.{name}" for module, name, _ in ROWS}
    assert {one.label for one in choices(WHOLE)} <= rows


def test_tables_are_halved_number_by_number() -> None:
    found = {one.label: one for one in tables(ROOMS)}
    assert found["gap.selection.surrogate.SIZES"].times(2.0) == (0.6, 2.0, 6.0, 20.0, 60.0)
    assert found["gap.inputs.spectrum_components.BROAD"].times(0.5) == ((0.04, 0.35), (0.1, 0.35))
    assert found["gap.selection.model_comparison.POWERS"].times(0.5) == ((1, 0), (1, 0), (0, 1), (0, 1), (1, 1))
    assert found["gap.selection.residual_anomalies.BESIDE"].times(0.5)[:3] == (-4, -4, -3)
    sizes = found["gap.selection.surrogate.SIZES"]
    assert with_others({sizes: sizes.times(2.0)}, lambda: surrogate.SIZES) == sizes.times(2.0) != surrogate.SIZES


def test_what_is_worked_out_or_no_number_is_no_table() -> None:
    """Ends of intervals come from CONFIDENCE; waves are functions."""
    names = {one.name for one in tables(WHOLE)}
    assert {"BROAD", "DEGREES", "BANDS"} <= names and not names & {"ENDS", "WAVES", "SLOWEST", "SURE"}


def test_modules_that_no_diagnosis_imports_have_no_constants_of_it() -> None:
    used = in_use()
    assert {"geocontact.gap.selection.verdict", "geocontact.identify.noise.covariance"} <= used
    assert "geocontact.identify.noise.autocorrelation" not in used and not constants(["identify.noise.autocorrelation"])


def test_places_of_a_sequence_are_no_choices() -> None:
    function = ast.parse("def f(x):\n    return x[3] + x[:, 4] + 7.0 * x[5 * x[6]:, 0]").body[0]
    assert isinstance(function, ast.FunctionDef)
    assert sorted(_numbers(function)) == [5, 7.0]
