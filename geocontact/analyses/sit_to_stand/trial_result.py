"""One trial as it was recorded and as the model moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.judged import JudgedMotion
from geocontact.standing_up.trials import StandingTrial


@dataclass(frozen=True, kw_only=True, eq=False)
class TrialResult:
    """One trial.

    Parameters
    ----------
    recorded, model
        Channels at the same times.
    acceleration
        Of the coordinates [m/s^2, rad/s^2].
    torque
        Of the joints of both legs [N m].
    judged
        Certificate, and residual between the points.
    """

    recorded: StandingTrial
    model: StandingTrial
    acceleration: Float[np.ndarray, "t 6"]
    torque: Float[np.ndarray, "t 3"]
    judged: JudgedMotion

    def residual(self, of: Float[np.ndarray, " f"]) -> Float[np.ndarray, " t"]:
        """Largest of a residual of `judged` nearest to each time of the recording."""
        time = self.recorded.time
        edges = np.r_[-np.inf, 0.5 * (time[:-1] + time[1:]), np.inf]
        place = np.searchsorted(edges, self.judged.time, "right") - 1
        largest = np.zeros(len(time))
        np.maximum.at(largest, place, of)
        return largest
