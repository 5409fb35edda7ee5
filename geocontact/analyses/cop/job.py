"""Centre of pressure, force and free moment of a foot on spheres: `geocontact cop`, `gc.centre_of_pressure`."""

from __future__ import annotations

from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.cop.read import read
from geocontact.analyses.cop.run import run
from geocontact.analyses.job import Job

centre_of_pressure = Job("cop", CopOptions, read, run)
