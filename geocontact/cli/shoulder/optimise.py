"""`geocontact shoulder optimise`."""

from __future__ import annotations

from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.cli.command import Command

HELP = """Support for each work phase, hand and task that unloads the shoulder most and never pushes the arm up.

Writes factors.csv (best, one factor for all, the paper's, each person's, by arm weight), scales.csv, simulated.csv,
outcomes.csv (planned), held_out.csv (made for the others, judged on one, with intervals), front.csv, a figure,
report.html and run.json into OUT.
"""

optimise = Command("geocontact.analyses.shoulder.optimise.result:optimise", ShoulderOptimiseOptions, HELP)
