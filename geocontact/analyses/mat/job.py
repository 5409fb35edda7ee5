"""A pressure mat on a body scan: `geocontact mat`, `gc.mat`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.read import read
from geocontact.analyses.mat.run import run

mat = Job("mat", MatOptions, read, run)
