"""Contacts from trials of standing up: `geocontact sit-to-stand calibrate`, `gc.sit_to_stand.calibrate`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.read import read
from geocontact.analyses.sit_to_stand.calibrate.run import run

calibrate = Job("sit-to-stand calibrate", StandingCalibrateOptions, read, run)
