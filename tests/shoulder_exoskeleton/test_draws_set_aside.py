"""Draws that a profile sets aside: no iterate is better, all choices by brute force, and no part of rounding."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from scipy.optimize import linprog

from geocontact.shoulder_exoskeleton.support import best_profile as programs
from geocontact.shoulder_exoskeleton.support.best_profile import best_profile, passed
from geocontact.shoulder_exoskeleton.support.draws_set_aside import AT_BOUND, best_kept
from geocontact.shoulder_exoskeleton.support.outcome import outcome
from geocontact.shoulder_exoskeleton.support.phase_machine import LIFT, LOWER, SCREW
from geocontact.shoulder_exoskeleton.support.profile_limits import Among, Limits, Rows, SupportCase

LIMITS = Limits(certainty=0.8)
TIME = np.arange(301) / 100.0
PHASE = np.array([LIFT, SCREW, LOWER])[np.minimum(TIME.astype(int), 2)]


def arm(task: str, needed: np.ndarray, full: np.ndarray) -> SupportCase:
    """An arm that needs and is given these torques while it lifts, screws and lowers; the pressure lags by 0.3 s."""
    needs, gives = (values[np.minimum(TIME.astype(int), 2)] for values in (needed, full))
    return SupportCase(task, "P1", task, "other", TIME, PHASE, needs, gives, 0.3, lever=0.2)


def among(seed: int) -> Among:
    """A person in four tasks, with 20 draws in which every torque of each phase errs by itself."""
    rng, needed, full = np.random.default_rng(seed), np.array([5.0, 6.0, 4.0]), np.full(3, 10.0)
    tasks = [f"T{k}" for k in range(1, 5)]
    draws = [
        [arm(task, needed * rng.uniform(0.5, 1.5, 3), full * rng.uniform(0.5, 1.5, 3)) for task in tasks]
        for _ in range(20)
    ]
    return Among([arm(task, needed, full) for task in tasks], {"P1": draws})


def rounded(case: SupportCase, rng: np.random.Generator, by: float) -> SupportCase:
    needed, full = (values * (1.0 + by * rng.normal(size=len(values))) for values in (case.needed, case.full))
    return replace(case, needed=needed, full=full)


@pytest.mark.parametrize("seed", [4, 8])
def test_rounding_has_no_part_in_the_choice(seed: int) -> None:
    """Draws that bind are at 1e-15 N m; which one was set aside hung on that and moved factors by 0.1."""
    exact = among(seed)
    wanted = best_profile(exact, LIMITS)
    for again in range(4):
        rng = np.random.default_rng(again)
        draws = [[rounded(case, rng, 1e-9) for case in draw] for draw in exact.drawn["P1"]]
        found = best_profile(Among([rounded(case, rng, 1e-9) for case in exact.cases], {"P1": draws}), LIMITS)
        assert found.value == pytest.approx(wanted.value, abs=1e-6)
        assert found.factors == pytest.approx(wanted.factors, abs=1e-4)


@pytest.mark.parametrize("aim", ["mean", "worst", "cvar"])
def test_no_iterate_that_keeps_the_limits_is_better(aim: programs.Aim, monkeypatch: pytest.MonkeyPatch) -> None:
    tried, solved = [], programs._solved

    def recorded(*given: object) -> np.ndarray:
        tried.append(solved(*given))  # type: ignore[arg-type]
        return tried[-1]

    monkeypatch.setattr(programs, "_solved", recorded)
    cases = among(4)
    best = best_profile(cases, LIMITS, aim)
    assert passed(cases, LIMITS, best.factors) <= AT_BOUND
    values = []
    for each in tried:
        factors = dict(zip(cases.keys, each.tolist(), strict=True))
        if passed(cases, LIMITS, factors) <= AT_BOUND:
            values.append(programs.measured([(c.person, outcome(c, factors).reduction) for c in cases.cases], aim))
    assert len(values) > 2 and best.value >= max(values) - 1e-7


def by_hand(draws: list[Rows], gain: np.ndarray, kept: tuple[int, ...]) -> np.ndarray:
    rows, most = (np.concatenate([draws[k][part] for k in kept]) for part in (0, 1))
    return np.asarray(linprog(-gain, A_ub=rows, b_ub=most, bounds=(0.0, 1.0)).x)


@pytest.mark.parametrize("seed", range(8))
def test_choices_beside_all_of_them(seed: int) -> None:
    """Of eight draws six are kept: the best of 28 choices is missed by at most 0.02."""
    rng = np.random.default_rng(seed)
    draws = [(rng.uniform(0.2, 1.0, (3, 2)), rng.uniform(0.3, 0.9, 3)) for _ in range(8)]
    gain = np.array([1.0, 0.7])
    ways = [by_hand(draws, gain, each) for each in combinations(range(8), 6)]
    values = np.array([gain @ each for each in ways])

    def solve(kept: object) -> np.ndarray:
        return by_hand(draws, gain, tuple(k for _, k in kept))  # type: ignore[attr-defined]

    found = best_kept(solve, lambda x: float(gain @ x), {"P": draws}, np.ones(2), 0.75)
    assert sum(bool(np.all(rows @ found <= most + 1e-9)) for rows, most in draws) >= 6
    assert values.max() - 0.02 <= gain @ found <= values.max() + 1e-9
