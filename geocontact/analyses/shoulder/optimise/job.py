"""Support profiles by linear programs: `geocontact shoulder optimise`, `gc.shoulder.optimise`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.read import read
from geocontact.analyses.shoulder.optimise.run import run

optimise = Job("shoulder optimise", ShoulderOptimiseOptions, read, run)
