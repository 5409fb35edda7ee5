"""What a prediction of standing up may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path

from geocontact.analyses.sit_to_stand.search_options import StandingSearchOptions


@dataclass(frozen=True)
class StandingPredictOptions(StandingSearchOptions):
    """Predict movement and strap force of trials that were not used, from ground reaction and torques.

    Parameters
    ----------
    study
        The trials (.toml). Their coordinates and strap are compared with, and only the first and last posture is used.
    parameters
        parameters.csv of a calibration with the exoskeleton.
    against
        Study of the trials of the calibration (.toml), whose mean is the trivial predictor.
    """

    study: Path
    _: KW_ONLY
    parameters: Path
    against: Path
