"""One trial as it was recorded, and as a model moves: at the recording's times and at the collocation points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.standing_up.phase import JudgedMotion
from geocontact.standing_up.trials import StandingTrial

Seen = Callable[[Float[np.ndarray, " t"]], StandingTrial]
"""What perfect encoders, plates and mats see of a motion at times [s]: `seen_in`, `seen_assisted`."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TrialResult:
    """One trial.

    Parameters
    ----------
    recorded, model
        Channels at the same times; torques of the model are those of both legs.
    points
        Channels of the model at `CollocatedMotion.held_times`, where the equations hold.
    acceleration
        Of the coordinates there [m/s^2, rad/s^2].
    judged
        Certificate, and residual between the points.
    """

    recorded: StandingTrial
    model: StandingTrial
    points: StandingTrial
    acceleration: Float[np.ndarray, "t n"]
    judged: JudgedMotion

    @property
    def certified(self) -> bool:
        """Whether the motion passes."""
        seen = self.judged.certificate
        return seen is not None and seen.converged

    def residual(self, of: Float[np.ndarray, " f"]) -> Float[np.ndarray, " t"]:
        """Largest of a residual of `judged` nearest to each time of the recording."""
        time = self.recorded.time
        edges = np.r_[-np.inf, 0.5 * (time[:-1] + time[1:]), np.inf]
        place = np.searchsorted(edges, self.judged.time, "right") - 1
        largest = np.zeros(len(time))
        np.maximum.at(largest, place, of)
        return largest


def trial_result(recorded: StandingTrial, motion: CollocatedMotion, judged: JudgedMotion, seen: Seen) -> TrialResult:
    """A recorded trial beside the motion that was found for it.

    Parameters
    ----------
    motion
        States are coordinates, rates and accelerations.
    seen
        Channels of this motion.
    """
    points = seen(motion.held_times)
    n = points.q.shape[1]
    return TrialResult(
        recorded=recorded,
        model=seen(recorded.time),
        points=points,
        acceleration=motion.state(motion.held_times)[:, 2 * n : 3 * n],
        judged=judged,
    )
