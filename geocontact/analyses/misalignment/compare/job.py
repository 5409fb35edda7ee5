"""A model of the elbow beside recordings: `geocontact elbow compare`, `gc.misalignment.compare`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.compare.read import read
from geocontact.analyses.misalignment.compare.run import run

compare = Job("elbow compare", CompareOptions, read, run)
