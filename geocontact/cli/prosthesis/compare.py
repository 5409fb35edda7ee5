"""`geocontact prosthesis compare`."""

from __future__ import annotations

from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.cli.command import Command

HELP = """Stances of a study, simulated, beside their force plates and beside two predictors without a model.

Writes summary.csv (means by setting), trials.csv (length, peaks, outliers and what is seen in them), errors.csv,
ensembles.csv, coordinates, external loads, spheres and numbers of each stance, a figure, report.html and run.json into
OUT.
"""

compare = Command("geocontact.analyses.prosthesis.compare.result:compare", ProsthesisCompareOptions, HELP)
