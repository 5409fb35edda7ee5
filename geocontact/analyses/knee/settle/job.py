"""The analysis of a contact equilibrium."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.analyses.knee.settle.read import read
from geocontact.analyses.knee.settle.run import run

settle = Job("knee settle", SettleOptions, read, run)
