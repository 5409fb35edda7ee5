"""A gap case of recordings: `geocontact gap gather`, `gc.gather`."""

from __future__ import annotations

from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.read import read
from geocontact.analyses.gap.gather.run import run
from geocontact.analyses.job import Job

gather = Job("gap gather", GatherOptions, read, run)
