"""What a support profile does in a case: how much of the shoulder's torque it takes over, and what it must not do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.support.phase_machine import SUPPORTED
from geocontact.shoulder_exoskeleton.support.profile_limits import FactorKey, Hand, SupportCase
from geocontact.shoulder_exoskeleton.work_phases import PHASES

Factors = dict[FactorKey, float]
_ROWS: tuple[tuple[str, Hand, tuple[float, float, float]], ...] = (
    ("T1", "dominant", (0.6, 1.0, 0.3)),
    ("T1", "other", (0.6, 0.6, 0.3)),
    ("T2", "dominant", (0.7, 1.0, 0.5)),
    ("T2", "other", (0.7, 1.0, 0.5)),
)
TABLE_3: Factors = {
    FactorKey(task, hand, PHASES[phase]): factor
    for task, hand, factors in _ROWS
    for phase, factor in zip(SUPPORTED, factors, strict=True)
}
"""Factors that the paper found by tuning, for its new cylinder of 12.8 N m."""
PRESENT = 7.8 / 12.8
"""Factor of the paper's present cylinder over the new one, in every phase."""


@dataclass(frozen=True)
class SupportOutcome:
    """Outcome of one profile in one case.

    Parameters
    ----------
    reduction
        Share of the mean magnitude of the shoulder's torque that the support takes away: 1 - mean |needed - support| /
        mean |needed|.
    pushed_up
        Share of the time in which the support exceeds what is needed: the arm has to be held down.
    excess
        Largest excess [N m].
    force
        Largest force at the interface [N].
    rate
        Largest rate of the support torque [N m/s]; of a plan that of the part that follows the factors.
    out_of_cuff
        Share of the time in which the sphere is out of the cuff; 0 in a plan, which knows of no cuff.
    """

    reduction: float
    pushed_up: float
    excess: float
    force: float
    rate: float
    out_of_cuff: float = 0.0


def outcome(case: SupportCase, factors: Factors) -> SupportOutcome:
    """Outcome of a profile that has a factor for each supported phase of the case."""
    steepest = float(np.abs(np.diff(case.given(factors)) / np.diff(case.time)).max())
    return outcome_of(case.needed, case.support(factors), float(case.force(factors).max()), steepest)


def outcome_of(
    needed: Float[np.ndarray, " t"], support: Float[np.ndarray, " t"], force: float, rate: float
) -> SupportOutcome:
    """Outcome of a torque on the arm beside the one that it needs [N m].

    Parameters
    ----------
    force
        Largest at the interface [N].
    rate
        Largest of the torque [N m/s].
    """
    over = support - needed
    given = support > TOLERANCE
    pushed = given & (over > TOLERANCE)
    return SupportOutcome(
        reduction=1.0 - float(np.abs(over).mean() / np.abs(needed).mean()),
        pushed_up=float(pushed.mean()),
        excess=float(np.max(over[given], initial=0.0)),
        force=force,
        rate=rate,
    )


TOLERANCE = 1e-6
"""N m below which a torque counts as none: what the solver leaves of its bounds."""
