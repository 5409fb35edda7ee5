"""`geocontact sit-to-stand calibrate`."""

from __future__ import annotations

from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.cli.command import Command

HELP = """Parameters of foot and ground that let a planar chain stand up as recorded, from several trials at once.

Writes parameters.csv (value, interval, and whether the trials tell it), errors.csv (how near each channel is),
certificate.csv (of the motion), correlation.csv, numbers.csv and mesh.csv (all that ran), model.osim, a table over time
and a trajectory for OpenSim's Moco for each trial, a figure, report.html and run.json into OUT.

Ctrl-C ends the search and keeps its last iterate.
"""

calibrate = Command("geocontact.analyses.sit_to_stand.calibrate.result:calibrate", StandingCalibrateOptions, HELP)
