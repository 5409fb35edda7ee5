"""What a comparison of predictions of standing up may be asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions


@dataclass(frozen=True)
class StandingCompareOptions(StandingPredictOptions):
    """Predictions of held-out trials compared with their recordings and with baseline predictors.

    Parameters
    ----------
    study
        The trials (.toml). Their coordinates and strap are compared with, and only the first and last posture is used.
    against
        Study of the trials of the calibration (.toml): their mean and the nearest of them are the trivial predictors.
    """

    writes: ClassVar[str] = """
    Writes comparison.csv (mean absolute error, root mean square and R² of every channel of every trial: with all given,
    without ground reaction, without torques, by the mean and by the nearest of the calibration's trials),
    certificate.csv, numbers.csv and mesh.csv (all that ran), a figure, report.html and run.json into OUT.
    """
