"""The programs that make a profile, beside loops over plain numbers: aims, limits, and outcomes of persons unlike."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.support.best_profile import Aim, Limits, best_profile, uniform_profile
from geocontact.shoulder_exoskeleton.support.outcome import outcome
from geocontact.shoulder_exoskeleton.support.phase_machine import SUPPORTED
from geocontact.shoulder_exoskeleton.support.profile_limits import FactorKey, SupportCase
from geocontact.shoulder_exoskeleton.work_phases import PHASES

GRID = (0.5, 0.8, 0.97, 1.03, 1.3)
"""Times the factors that were found."""


def a_case(person: str, count: int, seed: int, lever: float, task: str = "T1") -> SupportCase:
    rng = np.random.default_rng(seed)
    time = np.cumsum(rng.uniform(0.02, 0.3, count))
    phase = np.sort(rng.choice([0, *SUPPORTED], count))
    needed, full = rng.uniform(2.0, 9.0, count), rng.uniform(5.0, 14.0, count)
    return SupportCase(f"{person}{seed}", person, task, "other", time, phase, needed, full, 0.1, lever)


def some() -> list[SupportCase]:
    """Three persons with one, two and three cases of other lengths."""
    who = ("a", "b", "b", "c", "c", "c")
    return [a_case(person, 30 + 7 * k, k, 0.18 + 0.02 * k) for k, person in enumerate(who)]


def torque(case: SupportCase, factors: dict[FactorKey, float]) -> np.ndarray:
    """Support, phase by phase."""
    total = np.zeros(len(case.time))
    for k, key in enumerate(case.keys):
        total += factors[key] * case.per_factor[:, k]
    return total


def share_taken(case: SupportCase, factors: dict[FactorKey, float]) -> float:
    """Mean support over mean torque needed."""
    return float(sum(torque(case, factors)) / sum(case.needed))


def value(cases: list[SupportCase], factors: dict[FactorKey, float], aim: Aim) -> float:
    shares = {case.name: share_taken(case, factors) for case in cases}
    persons: dict[str, list[float]] = {}
    for case in cases:
        persons.setdefault(case.person, []).append(shares[case.name])
    means = [sum(own) / len(own) for own in persons.values()]
    if aim == "mean":
        return sum(means) / len(means)
    if aim == "worst":
        return min(means)
    worst = sorted(shares.values())[: len(cases) // 3]
    return sum(worst) / len(worst)


def kept(cases: list[SupportCase], factors: dict[FactorKey, float], limits: Limits) -> bool:
    for case in cases:
        given, acts = torque(case, factors), np.abs(case.per_factor).max(axis=1) > 0.02
        for t in np.flatnonzero(acts):
            if given[t] > 1e-9 + min((1.0 - limits.reserve) * case.needed[t], limits.force * case.lever):
                return False
        if (np.abs(np.diff(given)) > 1e-9 + limits.rate * np.diff(case.time)).any():
            return False
    return True


@pytest.mark.parametrize("aim", ["mean", "worst", "cvar"])
def test_aims_and_limits_by_hand(aim: Aim) -> None:
    """What is told is what the factors take; they keep every limit; none on a grid that keeps them takes more."""
    cases, limits = some(), Limits(force=18.0, rate=25.0, reserve=0.15)
    found = best_profile(cases, limits, aim, 1.0 / 3.0)
    assert found.value == pytest.approx(value(cases, found.factors, aim), rel=1e-7)
    assert kept(cases, {key: (1.0 - 1e-7) * each for key, each in found.factors.items()}, limits)
    keys = [FactorKey("T1", "other", PHASES[k]) for k in SUPPORTED]
    assert set(keys) == set(found.factors) and max(found.factors.values()) < 1.0
    tried = 0
    for each in itertools.product(GRID, repeat=len(keys)):
        factors = {key: by * found.factors[key] for key, by in zip(keys, each, strict=True)}
        if kept(cases, factors, limits):
            tried += 1
            assert value(cases, factors, aim) <= found.value + 1e-9
    assert tried > 10


def test_one_factor_by_hand() -> None:
    """The largest that every sample of every case lets pass; its share is the mean over persons."""
    cases, limits = some(), Limits(force=18.0, reserve=0.15)
    found = uniform_profile(cases, limits)
    most = 1.0
    for case in cases:
        for t in range(len(case.time)):
            whole = sum(case.per_factor[t])
            if max(abs(case.per_factor[t])) > 0.02:
                most = min(most, min(0.85 * case.needed[t], 18.0 * case.lever) / whole)
    assert list(found.factors.values()) == pytest.approx([most] * len(found.factors), rel=1e-9)
    assert found.value == pytest.approx(value(cases, found.factors, "mean"), rel=1e-9)


def test_outcome_by_hand() -> None:
    case = some()[4]
    factors = {key: 0.4 + 0.2 * k for k, key in enumerate(case.keys)}
    given = list(torque(case, factors))
    over = [g - n for g, n in zip(given, case.needed, strict=True)]
    found = outcome(case, factors)
    assert found.reduction == pytest.approx(1.0 - sum(map(abs, over)) / sum(case.needed), rel=1e-12)
    pushed = [g > 1e-6 and o > 1e-6 for g, o in zip(given, over, strict=True)]
    assert found.pushed_up == pytest.approx(sum(pushed) / len(pushed)) and any(pushed)
    assert found.excess == pytest.approx(max(o for g, o in zip(given, over, strict=True) if g > 1e-6))
    assert found.force == pytest.approx(max(map(abs, given)) / case.lever)
    rates = [abs((given[t] - given[t - 1]) / (case.time[t] - case.time[t - 1])) for t in range(1, len(given))]
    assert found.rate == pytest.approx(max(rates))
