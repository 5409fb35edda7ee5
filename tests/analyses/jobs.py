"""Every analysis of the package."""

from __future__ import annotations

from geocontact.analyses.catalogue import ENTRIES
from geocontact.analyses.frame.job import Job

JOBS: tuple[Job, ...] = tuple(entry.load_job() for entry in ENTRIES)
