"""What a prediction of standing up may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import ClassVar

from geocontact.analyses.sit_to_stand.search_options import StandingSearchOptions


@dataclass(frozen=True)
class StandingPredictOptions(StandingSearchOptions):
    """Movement and strap force of trials that were not used, with calibrated contacts.

    Parameters
    ----------
    study
        The trials (.toml). Their coordinates and strap are compared with, and only the first and last posture is used.
    parameters
        parameters.csv of a calibration with the exoskeleton.
    against
        Study of the trials of the calibration (.toml), whose mean is the trivial predictor.
    """

    writes: ClassVar[str] = """
    Writes errors.csv (how far every predictor is off: all given, without ground reaction, without torques, and the mean
    of the calibration's trials), certificate.csv, numbers.csv and mesh.csv (all that ran), a table over time and a
    trajectory for OpenSim's Moco for each trial, a figure, report.html and run.json into OUT.
    """

    study: Path
    _: KW_ONLY
    parameters: Path
    against: Path
