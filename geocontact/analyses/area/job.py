"""The area analysis, and the same analysis called for its pressures."""

from __future__ import annotations

from geocontact.analyses.area.options import AreaOptions, PressureOptions
from geocontact.analyses.area.read import read
from geocontact.analyses.area.run import run
from geocontact.analyses.job import Job

area = Job("area", AreaOptions, read, run)
pressure = Job("area", PressureOptions, read, run)
