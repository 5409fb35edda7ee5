"""A stance of a below-knee prosthesis: `geocontact prosthesis simulate`, `gc.prosthesis.simulate`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.read import read
from geocontact.analyses.prosthesis.simulate.run import run

simulate = Job("prosthesis simulate", ProsthesisSimulateOptions, read, run)
