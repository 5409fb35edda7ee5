"""Would an effect be found? `geocontact gap inject`, `gc.inject`."""

from __future__ import annotations

from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.analyses.gap.inject.read import read
from geocontact.analyses.gap.inject.run import run
from geocontact.analyses.job import Job

inject = Job("gap plant", InjectOptions, read, run)
