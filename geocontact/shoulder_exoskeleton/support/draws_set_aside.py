"""Which draws of the model's errors a profile keeps: a descent in which rounding has no part.

A share of each person's draws must be kept (`profile_limits`). It begins with the draws in which the optimum without
draws does least harm. An optimum under these may keep further ones; then as many of those that bind it are set aside,
each time the one without which the objective is largest. All draws that bind lie at their bounds within rounding, so
that their order by what is exceeded says nothing. A choice by whole draws has local optima; this ends in one of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.support.profile_limits import Rows, count_of, excess, mildest

Vector = Float[np.ndarray, " k"]
Draw = tuple[str, int]
"""A person, and the place of one of the person's draws."""
AT_BOUND = 1e-6
"""N m within which a draw's bound counts as kept, and as one that binds; the solver's own tolerance is 1e-7."""
SAME = 1e-7
"""Difference of two gains of the objective below which they count as equal; the first draw is then set aside."""


def best_kept(
    solve: Callable[[Sequence[Draw]], Vector],
    value: Callable[[Vector], float],
    drawn: Mapping[str, Sequence[Rows]],
    first: Vector,
    certainty: float,
) -> Vector:
    """Factors with the largest objective among all that were found and keep the share of each person's draws.

    Parameters
    ----------
    solve
        Factors that are best where these draws are kept.
    value
        Objective of factors.
    drawn
        Bounds of every person's draws.
    first
        Factors that are best without any draw.
    certainty
        Share of each person's draws that is kept.
    """
    kept = [(person, k) for person, draws in drawn.items() for k in mildest(draws, first, certainty)]
    best = solve(kept)
    most = value(best)
    while True:
        over = {person: [excess(rows, best) for rows in draws] for person, draws in drawn.items()}
        kept = [(person, k) for person, each in over.items() for k, by in enumerate(each) if by <= AT_BOUND]
        spare = {
            person
            for person, draws in drawn.items()
            if sum(each[0] == person for each in kept) > count_of(draws, certainty)
        }
        binding = [(person, k) for person, k in kept if person in spare and over[person][k] >= -AT_BOUND]
        if not binding:
            return best
        tried = [solve([each for each in kept if each != one]) for one in binding]
        values = [value(each) for each in tried]
        place = int(np.argmax(np.array(values) >= max(values) - SAME))
        if values[place] <= most + SAME:
            return best
        best, most = tried[place], values[place]
