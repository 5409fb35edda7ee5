"""A model made to measure from a static trial: `geocontact scale`, `gc.scale`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.motion.scale.read import read
from geocontact.analyses.motion.scale.run import run

scale = Job("scale", ScaleOptions, read, run)
