"""Many stances beside their plates: `geocontact prosthesis compare`, `gc.prosthesis.compare`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.read import read
from geocontact.analyses.prosthesis.compare.run import run

compare = Job("prosthesis compare", ProsthesisCompareOptions, read, run)
