"""The sole's numbers from stances that the whole model walks.

Damped Gauss-Newton steps from the calibration along recorded poses, with the same priors; height and pitch of the foot
beside its standing trial are sought on, from what that calibration found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.known_numbers import Knowledge, knowledge
from geocontact.below_knee_prosthesis.calibration.recorded_stance import WalkedStance
from geocontact.below_knee_prosthesis.calibration.whole_model import WholeResiduals
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import FootOffset
from geocontact.identify.optimise.bounded_gauss_newton import least
from geocontact.loads.sphere_set import SoleLaw

ROUNDS = 20
"""Simulations of the stances in the search, derivatives not counted."""
WORTH = 0.5
"""Cost that is not worth another step."""


@dataclass(frozen=True, eq=False)
class WholeCalibration:
    """What was found.

    Parameters
    ----------
    foot
        With the law that was found.
    logarithms
        Of the numbers over the usual ones.
    at
        Everything that was sought: the logarithms, then height and pitch in standard deviations.
    begun, cost
        Half the sum of squares at the numbers that it began with and at those found, priors included.
    converged
        Whether the search ended by itself.
    """

    residuals: WholeResiduals
    foot: VariableStiffnessFoot
    logarithms: Float[np.ndarray, " p"]
    at: Float[np.ndarray, " q"]
    begun: float
    cost: float
    converged: bool
    knowledge: Knowledge

    @property
    def offsets(self) -> tuple[FootOffset, ...]:
        """Offsets of the foot in each stance, beside its standing trial; none where they were not sought."""
        return self.knowledge.offsets

    @property
    def law(self) -> SoleLaw:
        """With the numbers that were found."""
        return self.foot.law


def calibrate_whole(
    stances: Sequence[WalkedStance],
    foot: VariableStiffnessFoot,
    begun: Float[np.ndarray, " p"],
    *,
    level: float = 0.95,
    machine_code: bool = True,
) -> WholeCalibration:
    """Around the law of `foot`, from what a calibration along the recorded poses found about it.

    Parameters
    ----------
    begun
        The logarithms, and height and pitch in standard deviations (`SoleCalibration.at`). Without these the foot stays
        as its standing trial has it.

    ArithmeticError where the stances cannot be simulated with these.
    """
    residuals = WholeResiduals(stances, foot, begun, machine_code=machine_code)
    reach, off = residuals.reach[: len(begun)], residuals(begun)
    search = least(residuals, residuals.slope, begun, -reach, reach, ROUNDS, WORTH)
    return WholeCalibration(
        residuals,
        residuals.at(search.x),
        search.x[: len(residuals.zones.names)],
        search.x,
        0.5 * float(off @ off),
        search.cost,
        search.finished,
        knowledge(residuals, search.x, level),
    )
