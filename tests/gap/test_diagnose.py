"""Whole diagnoses of synthetic cases: nothing, an effect, two, a mistake in the data, something unknown."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.gap.cases import elbow_case

from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.gap.diagnose import diagnose
from geocontact.systems.catalogue import system_of

DAMPING = {"damping.b": 15.0, "damping.exponent": 1.0}


def answer(case: GapCase) -> Diagnosis:
    return diagnose(case, system_of(case)).diagnosis


def check(found: Diagnosis) -> None:
    assert sum(found.probabilities.values()) == pytest.approx(1.0)
    assert (found.verdict == "explained") == bool(found.effects)
    for gap in found.gap.values():
        assert gap.ci95[0] <= gap.reduction <= gap.ci95[1]


@pytest.fixture(scope="module")
def damped() -> Diagnosis:
    return answer(elbow_case("damping", DAMPING, seed=1))


def test_nothing_is_missing_where_nothing_is() -> None:
    found = answer(elbow_case(seed=1))
    check(found)
    assert found.verdict == "no_gap"
    assert found.where == ()
    assert found.gap["force"].reduction == 0.0
    assert {"sensor_gain", "preload", "gravity_load"} <= set(found.absorbed)


def test_damping_is_named_and_measured(damped: Diagnosis) -> None:
    check(damped)
    assert damped.effects == ("damping",)
    assert damped.ambiguity[0] == "damping"
    own = damped.parameters["damping.b"]
    assert own.ci95[0] < 15.0 < own.ci95[1] or own.value == pytest.approx(15.0, rel=0.05)
    assert own.identifiable
    assert damped.where[0].stage == "constitutive"
    gap = damped.gap["force"]
    assert gap.rmse_after < 0.7 * gap.rmse_before


def test_name_and_order_of_trials_do_not_matter(damped: Diagnosis) -> None:
    case = elbow_case("damping", DAMPING, seed=1)
    renamed = {"t01": "zz", "t02": "a", "t03": "m", "t04": "b", "t05": "q"}
    other = replace(
        case,
        name="something else",
        calibration=tuple(replace(t, name=renamed[t.name]) for t in case.calibration[::-1]),
        evaluation=tuple(replace(t, name=renamed[t.name]) for t in case.evaluation[::-1]),
    )
    again = answer(other)
    assert again.effects == damped.effects
    for name, value in damped.probabilities.items():
        assert again.probabilities[name] == pytest.approx(value, abs=1e-3)


def test_two_effects_are_both_named() -> None:
    def late(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return np.interp(time - 0.15, time, force)

    friction = {"dry_friction.rate.limit": 1.5, "dry_friction.rate.turning": 0.003}
    found = answer(elbow_case("dry_friction.rate", friction, seed=2, change=late))
    check(found)
    assert set(found.effects) == {"dry_friction", "time_shift"}


@pytest.mark.parametrize("where", [("t01", "t02", "t03", "t04", "t05"), ("t02",), ("t05",)])
def test_a_wrong_unit_is_found_in_all_trials_or_some(where: tuple[str, ...]) -> None:
    found = answer(elbow_case(seed=4, change=lambda name, _, force: force * (1000.0 if name in where else 1.0)))
    assert found.effects == ("unit_error",)
    assert found.faults[0].trials == where
    assert found.faults[0].channel == "force"
    assert found.faults[0].factor == pytest.approx(1000.0)


def test_a_tremor_is_not_explained_by_anything_known() -> None:
    found = answer(elbow_case(seed=7, change=lambda _, time, force: force + 0.6 * np.sin(2.0 * np.pi * 6.5 * time)))
    check(found)
    assert found.verdict == "unknown"
    assert found.remarks
    assert found.gap["force"].reduction == 0.0
