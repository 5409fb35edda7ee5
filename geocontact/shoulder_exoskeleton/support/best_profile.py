"""Factors of support that take most of the shoulder's torque away without ever pushing the arm up: linear programs.

Support is linear in the factors and stays below what is needed, so what is taken away is linear as well, and so are the
limits on interface force and on the rate of the torque: the optimum is global. For a group: the mean over persons, the
worst person (minimax), or the mean of the worst share of all cases (conditional value at risk; Rockafellar & Uryasev
2000, Optimization of conditional value-at-risk, J Risk 2(3):21-41).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float, Int
from scipy.optimize import linprog

from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.support_case import FactorKey, SupportCase

Aim = Literal["mean", "worst", "cvar"]


@dataclass(frozen=True)
class Limits:
    """What a profile must keep.

    Parameters
    ----------
    force
        Largest force at the interface [N]; infinite for none.
    rate
        Largest rate of the support torque, up or down [N m/s]; infinite for none.
    reserve
        Share of the needed torque that is left to the shoulder at every moment.
    """

    force: float = np.inf
    rate: float = np.inf
    reserve: float = 0.0

    def __post_init__(self) -> None:
        if not (self.force > 0.0 and self.rate > 0.0 and 0.0 <= self.reserve < 1.0):
            raise ValueError("limits of force and rate must be positive, the reserve from 0 to below 1")


@dataclass(frozen=True)
class SupportProfile:
    """Factors for each task, hand and phase, and the share of the torque that they take away by the aim."""

    factors: Factors
    value: float


def best_profile(
    cases: Sequence[SupportCase], limits: Limits | None = None, aim: Aim = "mean", worst_share: float = 0.25
) -> SupportProfile:
    """The profile that is best for these cases.

    Parameters
    ----------
    aim
        "mean" over persons, "worst" person, or "cvar": mean over the worst cases.
    worst_share
        Of the cases, for "cvar".

    ValueError where there is no case, or where no factor keeps the limits.
    """
    if not cases:
        raise ValueError("there is no case to choose a profile for")
    if not 0.0 < worst_share <= 1.0:
        raise ValueError(f"a share of {worst_share:g} of the cases is not between 0 and 1")
    keys = tuple(dict.fromkeys(key for case in cases for key in case.keys))
    rows, bounds = _constraints(cases, keys, limits or Limits())
    gains = np.stack([_gain(case, keys) for case in cases])
    cost, more_rows, more_bounds, more = _aim(cases, gains, aim, worst_share)
    wide = np.zeros((len(rows), len(more)))
    found = linprog(
        cost,
        A_ub=np.concatenate((np.concatenate((rows, wide), axis=1), more_rows)),
        b_ub=np.concatenate((bounds, more_bounds)),
        bounds=[*[(0.0, 1.0)] * len(keys), *more],
        method="highs",
    )
    if found.x is None or found.fun is None:
        raise ValueError(f"no profile keeps the limits: {found.message}")
    return SupportProfile(dict(zip(keys, found.x[: len(keys)].tolist(), strict=True)), -float(found.fun))


def uniform_profile(cases: Sequence[SupportCase], limits: Limits | None = None) -> SupportProfile:
    """The best profile with one factor for every task, hand and phase: support without a state machine's knowledge."""
    keys = tuple(dict.fromkeys(key for case in cases for key in case.keys))
    rows, bounds = _constraints(cases, keys, limits or Limits())
    together = rows.sum(axis=1)
    rising = together > 0.0
    factor = float(np.clip(np.min(bounds[rising] / together[rising], initial=1.0), 0.0, 1.0))
    gains = np.stack([_gain(case, keys) for case in cases])
    return SupportProfile(dict.fromkeys(keys, factor), factor * float(_by_person(cases, gains).sum(axis=1).mean()))


def front(cases: Sequence[SupportCase], limits: Sequence[Limits], aim: Aim = "mean") -> list[SupportProfile]:
    """The best profile for each of several limits: a Pareto front of what they limit against what is taken away."""
    return [best_profile(cases, each, aim) for each in limits]


def _gain(case: SupportCase, keys: tuple[FactorKey, ...]) -> Float[np.ndarray, " k"]:
    """Share of the mean torque that each factor takes away."""
    found = np.zeros(len(keys))
    for key, column in zip(case.keys, case.per_factor.T, strict=True):
        found[keys.index(key)] = column.mean() / np.abs(case.needed).mean()
    return found


def _constraints(
    cases: Sequence[SupportCase], keys: tuple[FactorKey, ...], limits: Limits
) -> tuple[Float[np.ndarray, "m k"], Float[np.ndarray, " m"]]:
    """Rows A and b of A x <= b: needed torque, force, rate."""
    rows, bounds = [], []
    for case in cases:
        places = [keys.index(key) for key in case.keys]
        acts = np.abs(case.per_factor).max(axis=1) > ACTS
        most = np.minimum((1.0 - limits.reserve) * np.maximum(case.needed[acts], 0.0), limits.force * case.lever)
        binding = _binding(case.per_factor[acts], most)
        own = np.zeros((len(binding), len(keys)))
        own[:, places] = case.per_factor[acts][binding]
        rows.append(own)
        bounds.append(most[binding])
        if np.isfinite(limits.rate):
            slope = np.zeros((len(case.time) - 1, len(keys)))
            slope[:, places] = np.diff(case.per_factor, axis=0) / np.diff(case.time)[:, None]
            rows += [slope, -slope]
            bounds.append(np.full(2 * len(slope), limits.rate))
    return np.concatenate(rows), np.concatenate(bounds)


def _binding(rows: Float[np.ndarray, "m k"], most: Float[np.ndarray, " m"]) -> Int[np.ndarray, " b"]:
    """Moments whose bound can be reached: of a x <= b with a >= 0, none has larger a / b along every factor.

    Where a is negative somewhere, as of a lever beyond its dead centre, every moment counts.
    """
    if np.any(rows < 0.0):
        return np.arange(len(rows))
    with np.errstate(divide="ignore", invalid="ignore"):
        steep = np.nan_to_num(rows / most[:, None], nan=0.0, posinf=np.inf)
    left, kept = np.argsort(-steep.sum(axis=1), kind="stable"), []
    while len(left):
        kept.append(left[0])
        left = left[np.any(steep[left] > steep[left[0]], axis=1)]
    return np.array(kept, dtype=np.int64)


def _by_person(cases: Sequence[SupportCase], gains: Float[np.ndarray, "c k"]) -> Float[np.ndarray, "p k"]:
    """Mean of the gains of each person's cases."""
    persons = list(dict.fromkeys(case.person for case in cases))
    return np.stack([gains[[case.person == each for case in cases]].mean(axis=0) for each in persons])


ACTS = 0.02
"""N m at factor 1 below which support does not count: what the lag leaves long after a phase."""


def _aim(
    cases: Sequence[SupportCase], gains: Float[np.ndarray, "c k"], aim: Aim, worst_share: float
) -> tuple[
    Float[np.ndarray, " n"], Float[np.ndarray, "m n"], Float[np.ndarray, " m"], list[tuple[float | None, float | None]]
]:
    """Cost, rows, bounds and ranges with the variables that the aim adds to the factors."""
    count = gains.shape[1]
    of_person = _by_person(cases, gains)
    if aim == "mean":
        return -of_person.mean(axis=0), np.zeros((0, count)), np.zeros(0), []
    if aim == "worst":  # largest t with t <= gain of every person
        cost = np.append(np.zeros(count), -1.0)
        return cost, np.column_stack((-of_person, np.ones(len(of_person)))), np.zeros(len(of_person)), [(None, None)]
    shortfalls = len(cases)  # largest t - mean shortfall below t / worst_share
    cost = np.concatenate((np.zeros(count), [-1.0], np.full(shortfalls, 1.0 / (worst_share * shortfalls))))
    rows = np.column_stack((-gains, np.ones(shortfalls), -np.eye(shortfalls)))
    return cost, rows, np.zeros(shortfalls), [(None, None), *[(0.0, None)] * shortfalls]
