"""Which parameters of a phase its trials identify together, and which are better held.

Of the curvature of the cost at an answer, the motion following, the prior is taken off: the rest is the trials' own
information M on all candidates, in parts of their prior. Where directions of M have next to none, some of the
parameters are left out until those that stay are identified together (Van den Hof, Van Doren & Douma (2009),
Identification of parameters in large scale physical model structures; as subset selection by pivoting Golub, Klema &
Stewart (1976), Rank degeneracy and least squares problems). One after the other the parameter is taken of which most is
known beside those that were taken, whatever their values,

    M_jj - M_jS M_SS^-1 M_Sj

as long as each of them keeps at least `LEAST`, so that the trials at least halve its prior's deviation. What is held
stays at its prior mean, which is no better known by that: its covariance is part of the intervals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.optimality import inverse_reduced_hessian
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.standing_up.contact_numbers import HALF
from geocontact.standing_up.phase import RATE, PhaseProblem

LEAST = 1.0 / HALF**2 - 1.0
"""Information, in parts of the prior's, with which the prior's deviation is halved."""
Outcome = Literal["identified", "not identified", "coupled"]
Information = Float[np.ndarray, "k k"]


@dataclass(frozen=True)
class SelectedParameter:
    """One candidate.

    Parameters
    ----------
    alone, beside
        Information of the trials on it where all others are known, and where those that were taken are sought with it,
        in parts of the prior's; of one that was taken at its turn.
    outcome
        "identified": it is to be free. "not identified": not even where all others are known. "coupled": only where
        `partner` is known.
    turn
        In which it was taken, from 1; 0 for one that is held.
    """

    name: str
    alone: float
    beside: float
    outcome: Outcome
    turn: int
    partner: str = ""


def trials_information(phase: PhaseProblem, found: CollocationResult) -> Information:
    """Information of the trials on the parameters that a phase frees, in parts of their prior, about an answer.

    ValueError where the curvature does not exist.
    """
    names = [each.name for each in phase.parameters]
    at = [names.index(name) for name in phase.free]
    covariance = 2.0 / RATE * inverse_reduced_hessian(phase.control, found, [False] * len(names))
    sd = np.array([phase.parameters[k].sd for k in at])
    scaled = covariance[np.ix_(at, at)] / np.outer(sd, sd)
    return np.asarray(np.linalg.inv(scaled) - np.eye(len(at)))


def selected(names: Sequence[str], information: Information) -> tuple[SelectedParameter, ...]:
    """Every candidate in the order in which it was taken, then those that are held."""
    taken: list[int] = []
    rows: dict[int, SelectedParameter] = {}
    while True:
        left = [k for k in range(len(names)) if k not in taken]
        beside = {k: _beside(information, taken, k) for k in left}
        fit = [k for k in left if beside[k] >= LEAST and _least(information, [*taken, k]) >= LEAST]
        if not fit:
            break
        best = max(fit, key=lambda k: beside[k])
        taken.append(best)
        alone = float(information[best, best])
        rows[best] = SelectedParameter(names[best], alone, beside[best], "identified", len(taken))
    for k in sorted(left, key=lambda k: -information[k, k]):
        alone = float(information[k, k])
        coupled = alone >= LEAST and bool(taken)
        partner = names[_partner(information, taken, k)] if coupled else ""
        outcome: Outcome = "coupled" if coupled else "not identified"
        rows[k] = SelectedParameter(names[k], alone, beside[k], outcome, 0, partner)
    return tuple(rows.values())


def _beside(information: Information, taken: Sequence[int], k: int) -> float:
    """Schur complement: what is known of one where those that were taken are sought too."""
    if not taken:
        return float(information[k, k])
    cross = information[np.ix_(taken, [k])]
    answer = np.linalg.lstsq(information[np.ix_(taken, taken)], cross, rcond=None)[0]
    return float(information[k, k] - (cross.T @ answer)[0, 0])


def _least(information: Information, taken: Sequence[int]) -> float:
    """Least of what is known of each beside the others."""
    return min(_beside(information, [j for j in taken if j != k], k) for k in taken)


def _partner(information: Information, taken: Sequence[int], k: int) -> int:
    """The one that was taken which, were it known, would leave most of what is known of another."""
    return max(taken, key=lambda j: _beside(information, [i for i in taken if i != j], k))
