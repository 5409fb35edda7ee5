"""Which foot for whom: `geocontact prosthesis design`, `gc.prosthesis.design`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.read import read
from geocontact.analyses.prosthesis.design.run import run

design = Job("prosthesis design", ProsthesisDesignOptions, read, run)
