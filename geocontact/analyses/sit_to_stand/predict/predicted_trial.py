"""One trial by one predictor, and which trials a list of them has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial

ALL, MEAN = "all given", "mean of the calibration"


@dataclass(frozen=True, eq=False)
class PredictedTrial:
    """One trial by one predictor.

    Parameters
    ----------
    name
        Of the predictor.
    ending
        How the search ended, in words.
    seconds
        CPU time.
    """

    name: str
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
