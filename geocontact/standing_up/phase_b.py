"""Phase B: parameters of the strap, with those of the feet held.

Tracks what phase A does, and the torques of all joints and the strap's normal force besides; the squared energy of the
strap's other components is kept small (Table I of the study).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import Subject
from geocontact.standing_up.contact_parameter import usual
from geocontact.standing_up.exoskeleton import STRAP
from geocontact.standing_up.phase import PhaseProblem, standing_phase
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingNoise, StandingTrial

LITTLE_ENERGY = 1e-3
"""Weight of the squared energy [1/J^2]; ours."""
TRACKS_B = ("coordinates", "rates", "force", "centre", "torque", "strap")


def phase_b(
    model: StandingModel,
    subject: Subject,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    feet: Float[np.ndarray, " f"],
    *,
    free: Sequence[str] = STRAP,
    tracks: Sequence[str] = TRACKS_B,
    start: Float[np.ndarray, " s"] | None = None,
) -> PhaseProblem:
    """The problem whose solution has the strap's parameters.

    Parameters
    ----------
    feet
        What is searched of the feet's parameters, as phase A found it.
    start
        Where the search of the strap's parameters starts, unless at what is believed.
    """
    held = np.r_[feet, usual(model.parameters[len(feet) :])]
    begin = held if start is None else np.r_[feet, start]
    return standing_phase(
        model,
        subject,
        trials,
        noise,
        free=free,
        tracks=tracks,
        small={"energy": model.energy**2},
        held=held,
        start=begin,
        weights={"energy": LITTLE_ENERGY},
    )
