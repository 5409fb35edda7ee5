"""A person with a below-knee prosthesis made to measure: `geocontact prosthesis scale`, `gc.prosthesis.scale`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.scale.read import read
from geocontact.analyses.prosthesis.scale.run import run

scale = Job("prosthesis scale", ProsthesisScaleOptions, read, run)
