"""`geocontact shoulder compare`."""

from __future__ import annotations

from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.cli.command import Command

HELP = """Errors of a simulated exoskeleton arm beside its logger and a pressure mat, by channel and work phase.

Writes comparison.csv, a figure, report.html and run.json into OUT.
"""

compare = Command("geocontact.analyses.shoulder.compare.result:compare", ShoulderCompareOptions, HELP)
