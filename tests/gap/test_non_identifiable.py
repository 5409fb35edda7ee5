"""What refitted base parameters swallow, effects and mistakes in the data. Cases are synthetic."""

from __future__ import annotations

import pytest

from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.experiment.proposal import first_of
from geocontact.gap.identifiability.non_identifiable import (
    VISIBLE,
    Visibility,
    mistakes,
    non_identifiable,
    shown,
)
from geocontact.gap.levels import APART
from geocontact.gap_benchmark.drawing import Lot, drawn
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import elbow_case


def elbow() -> Problem:
    case = elbow_case(seed=1)
    return problem_of(case, system_of(case))


def listed() -> list[str]:
    problem = elbow()
    return [each.name for each in non_identifiable(problem, candidates(problem.system), ("preload",))]


def of_one(label: str) -> list[Visibility]:
    """A mistake at the elbow, k between 50 and 1000 N/m and in truth 260."""
    problem = elbow()
    return mistakes(problem, [one for one in candidates(problem.system) if one.label == label])


def at_the_seat() -> list[str]:
    case = drawn(Lot("sit_to_stand", "none", 20261135, 1)).case
    problem = problem_of(case, system_of(case))
    return [each.name for each in non_identifiable(problem, candidates(problem.system), ())]


def test_effects_and_mistakes_are_listed_the_best_hidden_first(elsewhere: Elsewhere) -> None:
    found = elsewhere(listed)
    assert found[:2] == ["sensor_gain", "unit_error"]
    assert "preload" not in found and len(found) == len(set(found)) <= 10


@pytest.mark.parametrize(
    ("label", "hidden"),
    [
        ("unit_error.force.1_over_4.4482", True),  # k becomes 58
        ("unit_error.force.1_over_9.8066", False),  # k would be 26, below its bound
        ("unit_error.force.1_over_1000", False),  # its noise is a thousandth, too
        ("unit_error.force.9.8066", False),  # 2550, above it
        ("sign_flip.force", False),
        ("sign_flip.beta", False),  # the model is nearly even in beta, not even
    ],
)
def test_a_unit_hides_as_far_as_bounds_of_parameters_let_it(elsewhere: Elsewhere, label: str, hidden: bool) -> None:
    (one,) = elsewhere(of_one, label)
    assert one.absorbed == hidden


def test_what_is_small_beside_a_mistake_may_still_be_a_gap() -> None:
    assert Visibility("unit_error", 1e-4, 0.1 * APART).absorbed
    assert not Visibility("unit_error", 1e-4, 10.0 * APART).absorbed
    assert not Visibility("sensor_gain", 2.0 * VISIBLE).absorbed


def test_a_mistake_is_shown_only_if_all_its_variants_are() -> None:
    hidden, small, faint, plain = (
        Visibility("unit_error", share, nats) for share, nats in ((1e-4, 0.1), (0.4, 0.3), (0.4, 9.0), (0.9, 2e3))
    )
    flips = Visibility("sign_flip", 0.5, 300.0), Visibility("sign_flip", 0.7, 200.0)
    assert shown([faint, *flips, plain]) == ("sign_flip", "unit_error")
    assert shown([faint, hidden, *flips, plain]) == ("sign_flip",)
    assert shown([faint, small, plain]) == (), "too small to be hidden, and to be seen"


@pytest.mark.slow
def test_a_reversed_rotation_hides_in_where_the_site_is(elsewhere: Elsewhere) -> None:
    assert "sign_flip" in elsewhere(at_the_seat)


def test_no_experiment_is_rehearsed_with_a_mistake() -> None:
    problem = elbow()
    found = first_of(candidates(problem.system), ["unit_error", "preload"])
    assert [one.name for one in found] == ["preload"]
