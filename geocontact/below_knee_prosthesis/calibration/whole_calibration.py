"""The sole's numbers from stances that the whole model walks.

Damped Gauss-Newton steps from the calibration along recorded poses, with the same priors; height and pitch of the foot
relative to its standing trial are sought on, from what that calibration found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.known_numbers import Knowledge, knowledge
from geocontact.below_knee_prosthesis.calibration.recorded_stance import WalkedStance
from geocontact.below_knee_prosthesis.calibration.whole_model import WholeResiduals
from geocontact.below_knee_prosthesis.from_markers import Walked
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import FootOffset
from geocontact.below_knee_prosthesis.leg_tree import LegMotion
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket, limb_in_socket
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.data.multibody.markers import MarkerTrajectories
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
        """Offsets of the foot beside each standing trial; none where they were not sought."""
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


def limb_on_sole(
    found: SoleCalibration,
    stance: WalkedStance,
    seen: MarkerTrajectories,
    fit: Walked,
    *,
    cutoff: float | None,
    gap_limit: float,
    turns: int,
    place: int = 0,
    machine_code: bool = True,
) -> LimbInSocket:
    """The limb's motion with the socket's taken out of its markers, along the stance on a calibrated sole.

    Parameters
    ----------
    found
        Sole, height and pitch by the calibration along the recorded poses.
    seen, fit
        Markers of the walk, and their fit with the foot as its standing trial has it.
    cutoff, gap_limit, turns
        As those of `limb_in_socket`.
    place
        Of the stance among those of the calibration.

    ArithmeticError where the stance cannot be simulated.
    """
    leg = fit.motion.leg.with_foot(found.offsets[found.residuals.standing[place]])
    first = replace(fit, motion=replace(fit.motion, leg=leg))
    span = (stance.begin, float(stance.recorded.time[-1]))

    def along(motion: LegMotion) -> Stance:
        given = motion, found.foot, stance.recorded.fulcrum, stance.push, span
        return simulate_stance(*given, machine_code=machine_code)

    return limb_in_socket(seen, first, along, cutoff=cutoff, gap_limit=gap_limit, turns=turns)


def along_limb(stance: WalkedStance, limb: LimbInSocket) -> WalkedStance:
    """The stance along the limb's own motion, with the foot where its standing trial has it."""
    return replace(stance, motion=replace(limb.walked.motion, leg=stance.motion.leg))
