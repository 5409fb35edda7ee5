"""`geocontact elbow simulate`."""

from __future__ import annotations

from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.cli.command import Command

HELP = """Forces of the explicit model along recorded angles, or synthetic recordings after the paper's experiment.

Writes a table for each trial (locked_1.csv …, free_1.csv …, or simulated_NAME.csv for a recording), truth.json,
numbers.csv with the source of every number, surfaces.csv and a figure of the displacement over angle and offsets,
report.html and run.json into OUT. The tables say that they are synthetic.
"""

simulate = Command("geocontact.analyses.misalignment.simulate.result:simulate", SimulateOptions, HELP)
