"""Stiffness, link and offsets of an exoskeleton: `geocontact elbow fit`, `gc.misalignment.identify`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.identify.read import read
from geocontact.analyses.misalignment.identify.run import run

identify = Job("elbow fit", IdentifyOptions, read, run)
