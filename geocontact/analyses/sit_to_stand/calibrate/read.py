"""What a calibration starts from: the person, the noise, and the trials."""

from __future__ import annotations

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.standing_trials import StandingUpTrials, standing_trials


def read(o: StandingCalibrateOptions, record: Record) -> StandingUpTrials:
    """Everything in the study."""
    return standing_trials(o.study, "study", record, o.c3d_unit)
