"""The sole's numbers from a stance: `geocontact prosthesis calibrate`, `gc.prosthesis.calibrate`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.calibrate.read import read
from geocontact.analyses.prosthesis.calibrate.run import run

calibrate = Job("prosthesis calibrate", ProsthesisCalibrateOptions, read, run)
