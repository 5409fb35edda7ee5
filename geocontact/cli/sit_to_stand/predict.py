"""`geocontact sit-to-stand predict`."""

from __future__ import annotations

from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.cli.command import Command

HELP = """Movement and strap force of trials that were not used, with calibrated contacts.

Writes errors.csv (how far every predictor is off: all given, without ground reaction, without torques, and the mean of
the calibration's trials), certificate.csv, numbers.csv and mesh.csv (all that ran), a table over time and a trajectory
for OpenSim's Moco for each trial, a figure, report.html and run.json into OUT.
"""

predict = Command("geocontact.analyses.sit_to_stand.predict.result:predict", StandingPredictOptions, HELP)
