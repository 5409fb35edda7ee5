"""A study of a shoulder exoskeleton: `geocontact shoulder study`, `gc.shoulder.study`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.shoulder.study.read import read
from geocontact.analyses.shoulder.study.run import run

study = Job("shoulder study", StudyOptions, read, run)
