"""A shoulder exoskeleton along human motion: `geocontact shoulder simulate`, `gc.shoulder.simulate`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.read import read
from geocontact.analyses.shoulder.simulate.run import run

simulate = Job("shoulder simulate", ShoulderSimulateOptions, read, run)
