"""Heavy tails of the noise carry no effect and hide none; a gap is no tail. All cases are synthetic."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.selection.model_comparison import base_contender, singles
from geocontact.gap.selection.surrogate import surrogate
from geocontact.gap.selection.tails import tails
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import NOISE, Change, elbow_case

STRUCK = 0.03
"""Of the samples, that are off by twenty standard deviations."""
DAMPED = {"damping.b": 6.0, "damping.exponent": 1.0}


def strikes(at_the_top: bool) -> Change:
    """A sensor that is struck: upwards where the force is large, or either way anywhere."""
    rng = np.random.default_rng(101)

    def struck(_: str, __: np.ndarray, force: np.ndarray) -> np.ndarray:
        often = np.where(force > np.quantile(force, 0.8), 5.0 * STRUCK, 0.0) if at_the_top else STRUCK
        there = rng.random(len(force)) < often
        out = force.copy()
        out[there] += 20.0 * NOISE * (1.0 if at_the_top else rng.choice([-1.0, 1.0], there.sum()))
        return out

    return struck


def gains(damped: bool, at_the_top: bool, names: Sequence[str]) -> tuple[dict[str, float], ...]:
    """What effects gain on a case with strikes [nats], without weights and with those of tails."""
    case = elbow_case("damping" if damped else "", DAMPED if damped else {}, 1, 8.0, recorded=strikes(at_the_top))
    problem = problem_of(case, system_of(case))
    offered = [one for one in candidates(problem.system) if one.name in names]
    found = []
    for _ in range(2):
        base = base_contender(problem)
        single = singles(problem, base, offered)
        found.append({c.label: c.nats - base.nats for c in single})
        leader = max((base, *single), key=lambda one: one.nats)
        problem = tails(problem, leader.judged, surrogate(problem, leader.judged).predicted).weighed(problem)
    return tuple(found)


def seen_without_tails() -> list[tuple[str, ...]]:
    """Channels with tails where noise is Gaussian and damping is missing: beside the base, and the surrogate on it."""
    case = elbow_case("damping", DAMPED, 1, 8.0)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    rest = surrogate(problem, base)
    assert rest.nats > 20.0
    return [tuple(tails(problem, base, rest.predicted).channels)]


@pytest.mark.slow
def test_strikes_carry_no_effect(elsewhere: Elsewhere) -> None:
    before, after = elsewhere(gains, False, True, ("saturation", "stiffening"))
    assert max(before.values()) > 30.0, "what was to be shown"
    assert max(after.values()) < 6.0


@pytest.mark.slow
def test_a_true_effect_comes_out_from_under_them(elsewhere: Elsewhere) -> None:
    before, after = elsewhere(gains, True, False, ("damping", "relaxation"))
    assert before["damping"] < before["relaxation"], "what was to be shown"
    assert after["damping"] > 100.0
    assert after["damping"] > after["relaxation"] + 5.0


def test_a_gap_is_no_tail(elsewhere: Elsewhere) -> None:
    assert elsewhere(seen_without_tails) == [()]
