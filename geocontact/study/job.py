"""Studies: `geocontact cohort`, `gc.cohort`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.study.options import CohortOptions
from geocontact.study.read import read
from geocontact.study.run import run

cohort = Job("cohort", CohortOptions, read, run)
