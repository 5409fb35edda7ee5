"""`geocontact shoulder study`."""

from __future__ import annotations

from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.cli.command import Command

HELP = """Simulate the arms of a study along the motion in the device and along that without it, beside logger and mat.

Writes summary.csv, errors.csv, differences.csv, passive.csv, a figure, report.html and run.json into OUT.
"""

study = Command("geocontact.analyses.shoulder.study.result:study", StudyOptions, HELP)
