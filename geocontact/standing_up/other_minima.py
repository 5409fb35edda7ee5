"""Other minima of a phase's cost: when they are looked for, and what they leave of a number's interval.

Laplace's interval knows the minimum that the search ended in and no other. On trials that another model made (own
Lagrangian, feedback at every joint) phase A ends in one of two: one with the modulus on its bound and the lowest points
at 80 mm, the other with both inside, 12 lower in minus twice the log posterior of 18455. Where a model fits, such a
difference would settle it; where it does not, squares count for too much, and differences are divided by `misfit` as
uncertainties are multiplied by its root elsewhere (Birge (1932), The calculation of errors by the method of least
squares, Phys Rev 40, 207-227).

So a phase is solved once more, from what is believed, where its answer can be doubted: a number that is sought ends on
its bound, or the misfit is larger than `DOUBTFUL`. The least of both is the answer. Another minimum within `RIVAL` of
it stays possible: a number that it puts outside the interval is not separable, and the interval covers both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.stats import norm

from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.standing_up.contact_numbers import ContactNumber, ContactNumbers, on_their_bounds
from geocontact.standing_up.contact_parameter import ContactParameter
from geocontact.standing_up.phase import RATE, PhaseProblem
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingTrial

DOUBTFUL = 1.2
"""Misfit above which the answer is sought again. Synthetic trials of the model itself have 0.83 to 0.84, those of
another one 1.7 to 2.0."""
RIVAL = 10.0
"""Rise of minus twice the log posterior, in parts of the misfit, below which another minimum stays possible: its height
is e^-5 of the best one's, 0.7 %."""
SAME_PLACE = 0.01
"""Of what is believed: parameters that come so near are those of one minimum."""


@dataclass(frozen=True)
class Ended:
    """How the search from one start ended.

    Parameters
    ----------
    objective
        Cost there.
    same
        Whether it is the minimum that was taken.
    """

    objective: float
    solved: bool
    same: bool


def misfit(
    model: StandingModel, trials: Sequence[StandingTrial], phase: PhaseProblem, found: CollocationResult
) -> float:
    """Least cost in parts of what noise alone would make of it.

    As many squares count as are recorded: those of the jerk are as many as the motion has free values.
    """
    n, squares = model.count, 0.0
    widths = {"coordinates": n, "rates": n, "force": 2, "centre": 1, "torque": n - 3}
    for trial in trials:
        width = sum(widths.get(name, 0) for name in phase.terms)
        if "strap" in phase.terms and trial.straps is not None:
            width += int(np.isfinite(trial.straps).all(axis=0).sum())
        squares += width * float(np.ptp(trial.time)) * trial.rate
    return RATE * found.objective / squares


def doubtful(phase: PhaseProblem, found: CollocationResult, misfits: float) -> bool:
    """Whether the answer is to be sought from another start, where anything is."""
    low, high = phase.control.p
    return bool((low < high).any() and (on_their_bounds(phase, found.p).any() or misfits > DOUBTFUL))


def ended(
    phase: PhaseProblem, runs: Sequence[tuple[PhaseProblem, CollocationResult]], best: CollocationResult
) -> tuple[Ended, ...]:
    """Every start's end; the first is the search's own."""
    return tuple(Ended(run.objective, run.solved, run.solved and _same(phase, run, best)) for _, run in runs)


def rivals(
    phase: PhaseProblem,
    runs: Sequence[tuple[PhaseProblem, CollocationResult]],
    best: CollocationResult,
    misfits: float,
) -> tuple[Float[np.ndarray, " p"], ...]:
    """Parameters of the other minima that stay possible."""
    most = RIVAL * max(1.0, misfits) / RATE
    near = [run for _, run in runs if run.solved and run.objective - best.objective <= most]
    return tuple(run.p for run in near if not _same(phase, run, best))


def beside_rivals(
    numbers: ContactNumbers,
    phase: PhaseProblem,
    p: Float[np.ndarray, " p"],
    others: Sequence[Float[np.ndarray, " p"]],
    level: float,
) -> ContactNumbers:
    """Numbers of the minimum at `p`, those that another minimum has outside their interval as not separable.

    The interval then has both, each as wide as it was, but no value of the other that is out of bounds; the standard
    deviation is that of an interval so wide.
    """
    reach = float(norm.ppf(0.5 + 0.5 * level))
    told = []
    for k, (of, number) in enumerate(zip(phase.parameters, numbers.numbers, strict=True)):
        off = [float(other[k] - p[k]) for other in others]
        out = number.verdict in ("known", "believed") and max(map(abs, off), default=0.0) > reach * number.after
        told.append(_with_rivals(of, number, off, reach) if out else number)
    return replace(numbers, numbers=tuple(told))


def _with_rivals(of: ContactParameter, number: ContactNumber, off: Sequence[float], reach: float) -> ContactNumber:
    best, half = of.searched(number.value), reach * number.after
    least, most = of.searched(of.least), of.searched(of.most)
    low = min(best - half, max(best + min(off) - half, least))
    high = max(best + half, min(best + max(off) + half, most))
    return replace(
        number,
        lower=of.value(low),
        upper=of.value(high),
        after=0.5 * (high - low) / reach,
        verdict="not separable",
    )


def _same(phase: PhaseProblem, one: CollocationResult, other: CollocationResult) -> bool:
    believed = np.array([each.sd for each in phase.parameters])
    return bool((np.abs(one.p - other.p) <= SAME_PLACE * believed).all())
