"""Predictions beside recordings: `geocontact sit-to-stand compare`, `gc.sit_to_stand.compare`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.analyses.sit_to_stand.compare.run import run
from geocontact.analyses.sit_to_stand.predict.read import read

compare = Job("sit-to-stand compare", StandingCompareOptions, read, run)
