"""A simulated arm beside logger and mat: `geocontact shoulder compare`, `gc.shoulder.compare`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.analyses.shoulder.compare.read import read
from geocontact.analyses.shoulder.compare.run import run

compare = Job("shoulder compare", ShoulderCompareOptions, read, run)
