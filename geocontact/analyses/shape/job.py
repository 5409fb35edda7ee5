"""Cylinder, sphere or plane fitted to a surface: `geocontact fit`, `gc.fit_shape`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.analyses.shape.read import read
from geocontact.analyses.shape.run import run

fit_shape = Job("fit", ShapeOptions, read, run)
