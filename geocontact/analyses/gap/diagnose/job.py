"""Which effect a model lacks: `geocontact gap diagnose`, `gc.diagnose`."""

from __future__ import annotations

from geocontact.analyses.gap.diagnose.many import read_folders, run_many
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions, ManyOptions
from geocontact.analyses.gap.diagnose.read import read
from geocontact.analyses.gap.diagnose.run import run
from geocontact.analyses.job import Job

diagnose = Job("gap diagnose", DiagnoseOptions, read, run)
diagnose_many = Job("gap diagnose", ManyOptions, read_folders, run_many)
