"""Profile of a parameter: how far the cost rises where it is held beside its best and all else is sought again.

RATE times the rise of the cost is that of minus twice the logarithm of the posterior, so that an interval of 95 % ends
where it is 3.84 (Venzon & Moolgavkar (1988), A method for computing profile-likelihood-based confidence intervals, J R
Stat Soc C 37, 87-94). Laplace's interval says that it rises as the square of the distance; the profile says whether.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.standing_up.contact_numbers import WITH_INTERVAL, ContactNumbers
from geocontact.standing_up.phase import RATE, PhaseProblem

FARTHEST = 3.0
"""Standard deviations to either side."""


@dataclass(frozen=True, eq=False)
class PhaseProfile:
    """One parameter.

    Parameters
    ----------
    distance
        From the best, in standard deviations of Laplace's interval; 0 is among them.
    places
        Values of the parameter, in `unit`.
    rise
        Of minus twice the logarithm of the posterior; not a number where the search had no answer. Laplace's would be
        the square of the distance.
    """

    name: str
    unit: str
    distance: Float[np.ndarray, " k"]
    places: Float[np.ndarray, " k"]
    rise: Float[np.ndarray, " k"]


def profiles(
    phase: PhaseProblem,
    found: CollocationResult,
    numbers: ContactNumbers,
    points: int,
    solve: Callable[[PhaseProblem, CollocationResult], CollocationResult],
) -> tuple[PhaseProfile, ...]:
    """Profiles of all parameters that have an interval, so many points to either side, each search from the one before.

    Parameters
    ----------
    solve
        A phase's problem from a result.
    """
    made = []
    low, high = phase.control.p
    for k, (each, number) in enumerate(zip(phase.parameters, numbers.numbers, strict=True)):
        if number.verdict not in WITH_INTERVAL:
            continue
        rise, values = {0.0: 0.0}, {0.0: float(found.p[k])}
        for side in (-1.0, 1.0):
            last = found
            for distance in side * FARTHEST * np.arange(1, points + 1) / points:
                at = float(np.clip(found.p[k] + distance * number.by_trials, low[k], high[k]))
                least, most, begin = (
                    np.where(np.arange(len(low)) == k, at, of) for of in (low, high, phase.control.guess_p)
                )
                held = replace(phase, control=replace(phase.control, p=(least, most), guess_p=begin))
                last = solve(held, last)
                rise[distance] = RATE * (last.objective - found.objective) if last.solved else np.nan
                values[distance] = at
        order = np.array(sorted(rise))
        made.append(
            PhaseProfile(
                each.name,
                each.unit,
                order,
                np.array([each.value(values[d]) for d in order]),
                np.array([rise[d] for d in order]),
            )
        )
    return tuple(made)
