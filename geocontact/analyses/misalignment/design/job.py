"""Offsets and strokes that keep a force under a limit: `geocontact elbow design`, `gc.misalignment.design`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.analyses.misalignment.design.read import read
from geocontact.analyses.misalignment.design.run import run

design = Job("elbow design", DesignOptions, read, run)
