"""What a comparison of predictions of standing up may be asked for."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions


@dataclass(frozen=True)
class StandingCompareOptions(StandingPredictOptions):
    """Set predictions of trials that were not used beside their recordings and beside two predictors without a model.

    Parameters
    ----------
    study
        The trials (.toml). Their coordinates and strap are compared with, and only the first and last posture is used.
    against
        Study of the trials of the calibration (.toml): their mean and the nearest of them are the trivial predictors.
    """
