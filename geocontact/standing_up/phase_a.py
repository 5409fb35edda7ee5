"""Phase A: parameters of the feet from passive trials, all at once.

Tracks coordinates, rates, ground reaction force and centre of pressure; little torque and jerk besides (Table I of the
study, interface forces none).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import Subject
from geocontact.standing_up.contact_parameter import usual
from geocontact.standing_up.feet import LAW
from geocontact.standing_up.phase import FOOT_JERK, JOINT_JERK, PhaseProblem, standing_phase
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import SPRINGS, STRAP_SITES
from geocontact.standing_up.trials import StandingNoise, StandingTrial

LITTLE_TORQUE = 1e-6
"""Weight of the torques' squares [1/(N m)^2]; ours."""
SLACK = -30.0
"""What is searched of a strap's stiffnesses that are as good as 0."""
TRACKS = ("coordinates", "rates", "force", "centre")


def phase_a(
    model: StandingModel,
    subject: Subject,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    *,
    free: Sequence[str] = LAW,
    tracks: Sequence[str] = TRACKS,
    start: Float[np.ndarray, " p"] | None = None,
    jerk_sizes: tuple[float, float] = (FOOT_JERK, JOINT_JERK),
) -> PhaseProblem:
    """The problem whose solution has the parameters; see `standing_phase`.

    An exoskeleton's straps have no stiffness here: its chain stands up by its own torques, as in the study.
    """
    from casadi import sumsqr

    small = {"torques": sumsqr(model.torques)}
    held = usual(model.parameters)
    springs = {name for site in STRAP_SITES for name in site.names[: len(SPRINGS)]}
    held[[each.name in springs for each in model.parameters]] = SLACK
    return standing_phase(
        model,
        subject,
        trials,
        noise,
        free=free,
        tracks=tracks,
        small=small,
        held=held,
        start=start,
        jerk_sizes=jerk_sizes,
        weights={"torques": LITTLE_TORQUE},
    )
