"""`geocontact elbow fit`."""

from __future__ import annotations

from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.cli.command import Command

HELP = """Stiffness, link and offsets of an exoskeleton from force and angle, and what these recordings cannot tell.

Writes elbow.json, bins.csv, boxes.csv, intervals.csv, scale_line.csv, held_out.csv, numbers.csv (all that ran, with
unit and source), figures (.png, .svg), report.html and run.json into OUT, with `unlocked` also conditions.csv and
boxes_free.csv. k, x, y, l and z are known up to one factor only, unless one of them comes from elsewhere.
"""

fit = Command("geocontact.analyses.misalignment.identify.job:identify", IdentifyOptions, HELP)
