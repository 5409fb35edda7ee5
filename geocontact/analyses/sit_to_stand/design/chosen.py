"""What a run finds: designs by name, each with its certified movements, and what draws make of the gain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.standing_up.assistance.design import HelpDesign
from geocontact.standing_up.assistance.movement import Movement

WORN, ALONE, BEST, ROBUST = "without help", "share alone", "chosen", "chosen for the draws"


@dataclass(frozen=True, eq=False)
class CertifiedDesign:
    """One exoskeleton and the movement with it.

    Parameters
    ----------
    name
        As tables call it.
    limit
        Of the knee's true peak, as part of that without help; not a number without a limit.
    design
        None where nothing was sought.
    trials
        By the calibrated parameters.
    """

    name: str
    limit: float
    design: HelpDesign | None
    movement: Movement
    trials: tuple[TrialResult, ...]

    @property
    def certified(self) -> bool:
        """Whether every movement is."""
        seen = [trial.judged.certificate for trial in self.trials]
        return all(each is not None and each.converged for each in seen)


@dataclass(frozen=True, eq=False)
class DrawnGain:
    """The aim with one drawn set of parameters, by the exoskeleton that is compared with and by the chosen one.

    Parameters
    ----------
    reference, chosen, knee
        Smooth peaks, or mean energy, and the knee's torque with the chosen one.
    largest_reference, largest_chosen, largest_knee
        True peaks.
    """

    reference: float
    chosen: float
    knee: float
    largest_reference: float
    largest_chosen: float
    largest_knee: float

    @property
    def gain(self) -> float:
        """Part of the reference that is saved."""
        return 1.0 - self.chosen / self.reference


def gain_interval(draws: tuple[DrawnGain, ...], level: float = 0.95) -> tuple[float, float]:
    """In which the gain of another draw lies, by Student's distribution; not numbers for fewer than two."""
    if len(draws) < 2:
        return float("nan"), float("nan")
    from scipy.stats import t

    gains: Float[np.ndarray, " d"] = np.array([each.gain for each in draws])
    reach = float(t.ppf(0.5 + 0.5 * level, len(gains) - 1) * gains.std(ddof=1) * np.sqrt(1.0 + 1.0 / len(gains)))
    return float(gains.mean()) - reach, float(gains.mean()) + reach
