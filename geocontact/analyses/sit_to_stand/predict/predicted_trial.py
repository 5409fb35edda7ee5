"""One trial by one predictor, and which trials a list of them has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.standing_up.phase import PhaseProblem
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingTrial

ALL, MEAN = "all given", "mean of the calibration"


@dataclass(frozen=True, eq=False)
class PredictedTrial:
    """One trial by one predictor.

    Parameters
    ----------
    name
        Of the predictor.
    model, phase
        What moved, and the problem that was solved.
    motion, p, objective
        Its solution, and what it costs.
    ending
        How the search ended, in words.
    seconds
        CPU time.
    """

    name: str
    model: StandingModel
    phase: PhaseProblem
    motion: CollocatedMotion
    p: Float[np.ndarray, " p"]
    objective: float
    trial: TrialResult
    solved: bool
    ending: str
    iterations: int
    seconds: float

    @property
    def certified(self) -> bool:
        """Whether the motion passes."""
        seen = self.trial.judged.certificate
        return seen is not None and seen.converged


def trials_begun(predictions: Sequence[PredictedTrial]) -> tuple[StandingTrial, ...]:
    """Recordings of the trials that are predicted, each once."""
    return tuple({one.trial.recorded.name: one.trial.recorded for one in predictions}.values())
