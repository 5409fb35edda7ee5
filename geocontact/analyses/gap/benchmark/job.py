"""How often the diagnosis is right: `geocontact gap benchmark`."""

from __future__ import annotations

from geocontact.analyses.gap.benchmark.options import BenchmarkOptions
from geocontact.analyses.gap.benchmark.read import read
from geocontact.analyses.gap.benchmark.run import run
from geocontact.analyses.job import Job

benchmark = Job("gap benchmark", BenchmarkOptions, read, run)
