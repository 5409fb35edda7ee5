"""Contact forces from the load cells of an implant: `geocontact loadcells`, `gc.load_cells`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.loadcells.options import LoadcellOptions
from geocontact.analyses.loadcells.read import read
from geocontact.analyses.loadcells.run import run

load_cells = Job("loadcells", LoadcellOptions, read, run)
