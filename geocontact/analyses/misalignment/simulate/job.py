"""Synthetic recordings of an exoskeleton at an elbow: `geocontact elbow simulate`, `gc.misalignment.simulate`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.analyses.misalignment.simulate.read import read
from geocontact.analyses.misalignment.simulate.run import run

simulate = Job("elbow simulate", SimulateOptions, read, run)
