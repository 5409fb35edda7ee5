"""`geocontact elbow compare`."""

from __future__ import annotations

from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.cli.command import Command

HELP = """Errors of a model of the elbow beside recordings: mean absolute, root mean square, R², by channel and trial.

Writes comparison.csv, a figure for each channel, report.html and run.json into OUT.
"""

compare = Command("geocontact.analyses.misalignment.compare.result:compare", CompareOptions, HELP)
