"""Factors of support that take most of the shoulder's torque away without ever pushing the arm up: linear programs.

Support is linear in the factors and stays below what is needed, so what is taken away is linear as well, and so are the
limits on interface force and on the rate of the torque: the optimum is global. For a group: the mean over persons, the
worst person (minimax), or the mean of the worst share of all cases (conditional value at risk; Rockafellar & Uryasev
2000, Optimization of conditional value-at-risk, J Risk 2(3):21-41). What is kept in a share of the draws of the model's
errors only: `draws_set_aside` chooses which.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.optimize import linprog

from geocontact.shoulder_exoskeleton.support.draws_set_aside import Draw, best_kept
from geocontact.shoulder_exoskeleton.support.outcome import Factors, outcome
from geocontact.shoulder_exoskeleton.support.profile_limits import (
    Among,
    FactorKey,
    Limits,
    Rows,
    SupportCase,
    count_of,
    excess,
    joined,
    mildest,
    nominal_rows,
)

Aim = Literal["mean", "worst", "cvar"]


@dataclass(frozen=True)
class SupportProfile:
    """Factors for each task, hand and phase, and the share of the torque that they take away by the aim.

    Parameters
    ----------
    factors
        At scale 1.
    scales
        By person what they are multiplied by.
    """

    factors: Factors
    value: float
    scales: Mapping[str, float] = field(default_factory=dict)

    def of(self, person: str) -> Factors:
        """The person's own factors."""
        return scaled(self.factors, self.scales.get(person, 1.0))


def scaled(factors: Mapping[FactorKey, float], scale: float) -> Factors:
    """Factors times a scale; a cylinder gives no more than all of its torque."""
    return {key: min(1.0, scale * value) for key, value in factors.items()}


def best_profile(
    cases: Sequence[SupportCase] | Among, limits: Limits | None = None, aim: Aim = "mean", worst_share: float = 0.25
) -> SupportProfile:
    """The profile that is best for these cases.

    Parameters
    ----------
    cases
        Or these with draws of the model's errors and with scales.
    aim
        "mean" over persons, "worst" person, or "cvar": mean over the worst cases.
    worst_share
        Of the cases, for "cvar".

    ValueError where there is no case, or where no factor keeps the limits.
    """
    among, kept = _among(cases), limits or Limits()
    if not 0.0 < worst_share <= 1.0:
        raise ValueError(f"a share of {worst_share:g} of the cases is not between 0 and 1")
    nominal, highest = nominal_rows(among, kept), among.highest(kept.caps)
    drawn = {each: [_less(rows, kept.margin) for rows in of] for each, of in _drawn(among, kept).items()}

    def solve(draws: Sequence[Draw]) -> Float[np.ndarray, " k"]:
        rows = joined([nominal, *(drawn[each][k] for each, k in draws)]) if draws else nominal
        return _solved(among, rows, highest, aim, worst_share)

    def profile(found: Float[np.ndarray, " k"]) -> SupportProfile:
        return _profile(among, dict(zip(among.keys, found.tolist(), strict=True)), aim, worst_share)

    found = solve(())
    return profile(best_kept(solve, lambda x: profile(x).value, drawn, found, kept.certainty) if drawn else found)


def uniform_profile(
    cases: Sequence[SupportCase] | Among, limits: Limits | None = None, aim: Aim = "mean", worst_share: float = 0.25
) -> SupportProfile:
    """The best profile with one factor for every task, hand and phase: support without a state machine's knowledge."""
    among, kept = _among(cases), limits or Limits()
    factor = min(_largest(nominal_rows(among, kept)), float(among.highest(kept.caps).min()))
    for draws in _drawn(among, kept).values():
        each = np.sort([_largest(_less(rows, kept.margin)) for rows in draws])
        factor = min(factor, float(each[-count_of(draws, kept.certainty)]))
    return _profile(among, dict.fromkeys(among.keys, factor), aim, worst_share)


def front(
    cases: Sequence[SupportCase] | Among, limits: Sequence[Limits], aim: Aim = "mean", worst_share: float = 0.25
) -> list[SupportProfile]:
    """The best profile for each of several limits: a Pareto front of what they limit against what is taken away."""
    return [best_profile(cases, each, aim, worst_share) for each in limits]


def passed(cases: Sequence[SupportCase] | Among, limits: Limits, factors: Factors) -> float:
    """By how much a profile passes the worst of its limits in these cases; at most 0 where it keeps them all [N m]."""
    among = _among(cases)
    x = np.array([factors[key] for key in among.keys])
    found = excess(nominal_rows(among, limits), x)
    for draws in _drawn(among, limits).values():
        found = max(found, *(excess(draws[k], x) for k in mildest(draws, x, limits.certainty)))
    return found


def measured(taken: Sequence[tuple[str, float]], aim: Aim, worst_share: float = 0.25) -> float:
    """Share of the torque that is taken away, by the aim.

    Parameters
    ----------
    taken
        Of each case its person, and the share there.
    """
    values = np.array([value for _, value in taken])
    if aim == "cvar":
        weight = np.clip(worst_share * len(values) - np.arange(len(values)), 0.0, 1.0)
        return float(weight @ np.sort(values) / weight.sum())
    persons = np.array([person for person, _ in taken])
    means = [values[persons == each].mean() for each in dict.fromkeys(persons)]
    return float(min(means) if aim == "worst" else np.mean(means))


def _among(cases: Sequence[SupportCase] | Among) -> Among:
    among = cases if isinstance(cases, Among) else Among(cases)
    if not among.cases:
        raise ValueError("there is no case to choose a profile for")
    return among


def _drawn(among: Among, limits: Limits) -> dict[str, list[Rows]]:
    return among.never_pushed_up if limits.certainty > 0.0 else {}


def _less(rows: Rows, margin: float) -> Rows:
    """Bounds that are lower by a margin [N m], but not below 0."""
    return rows[0], np.maximum(rows[1] - margin, 0.0)


def _largest(rows: Rows) -> float:
    """One factor that keeps all bounds."""
    together = rows[0].sum(axis=1)
    rising = together > 0.0
    return float(np.clip(np.min(rows[1][rising] / together[rising], initial=1.0), 0.0, 1.0))


def _profile(among: Among, factors: Factors, aim: Aim, worst_share: float) -> SupportProfile:
    """With what the factors take away, of what is needed as it is."""
    made = SupportProfile(factors, 0.0, among.scales)
    taken = [(case.person, outcome(case, made.of(case.person)).reduction) for case in among.cases]
    return SupportProfile(factors, measured(taken, aim, worst_share), among.scales)


def _solved(
    among: Among, rows: Rows, highest: Float[np.ndarray, " k"], aim: Aim, worst_share: float
) -> Float[np.ndarray, " k"]:
    """Factors of the linear program with these rows, none above its highest value."""
    count = len(among.keys)
    cost, more_rows, more_bounds, more = _aim(among, aim, worst_share)
    wide = np.zeros((len(rows[0]), len(more)))
    found = linprog(
        cost,
        A_ub=np.concatenate((np.concatenate((rows[0], wide), axis=1), more_rows)),
        b_ub=np.concatenate((rows[1], more_bounds)),
        bounds=[*((0.0, each) for each in highest), *more],
        method="highs",
    )
    if found.x is None:
        raise ValueError(f"no profile keeps the limits: {found.message}")
    return np.asarray(found.x[:count])


def _gains(among: Among) -> tuple[Float[np.ndarray, "c k"], Float[np.ndarray, " c"]]:
    """By case the share of the mean torque that each factor takes away, and the one without any."""
    means = np.array([np.abs(case.needed).mean() for case in among.cases])
    each = [among.columns(case, case.per_factor.mean(axis=0)[None])[0] for case in among.cases]
    none = np.array([np.mean(case.own) for case in among.cases])
    return np.stack(each) / means[:, None], none / means


def _by_person(cases: Sequence[SupportCase], values: Float[np.ndarray, "c k"]) -> Float[np.ndarray, "p k"]:
    """Mean over each person's cases."""
    persons = list(dict.fromkeys(case.person for case in cases))
    return np.stack([values[[case.person == each for case in cases]].mean(axis=0) for each in persons])


def _aim(
    among: Among, aim: Aim, worst_share: float
) -> tuple[
    Float[np.ndarray, " n"], Float[np.ndarray, "m n"], Float[np.ndarray, " m"], list[tuple[float | None, float | None]]
]:
    """Cost, rows, bounds and ranges with the variables that the aim adds to the factors."""
    gains, none = _gains(among)
    count = gains.shape[1]
    of_person = _by_person(among.cases, gains)
    if aim == "mean":
        return -of_person.mean(axis=0), np.zeros((0, count)), np.zeros(0), []
    if aim == "worst":  # largest t with t <= what is taken away of every person
        cost = np.append(np.zeros(count), -1.0)
        rows = np.column_stack((-of_person, np.ones(len(of_person))))
        return cost, rows, _by_person(among.cases, none[:, None])[:, 0], [(None, None)]
    shortfalls = len(among.cases)  # largest t - mean shortfall below t / worst_share
    cost = np.concatenate((np.zeros(count), [-1.0], np.full(shortfalls, 1.0 / (worst_share * shortfalls))))
    rows = np.column_stack((-gains, np.ones(shortfalls), -np.eye(shortfalls)))
    return cost, rows, none, [(None, None), *[(0.0, None)] * shortfalls]
