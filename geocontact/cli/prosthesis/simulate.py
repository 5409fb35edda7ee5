"""`geocontact prosthesis simulate`."""

from __future__ import annotations

from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.cli.command import Command

HELP = """Ground reaction under a variable-stiffness prosthetic foot along a recorded walk, prosthetic side alone.

Writes stance.csv, errors.csv and curves.csv beside a force plate, numbers.csv with the source of every number,
coordinates.sto, ground_reaction.mot and .xml (external loads for OpenSim and `geocontact id`), paraview, a figure,
report.html (moving foot with forces) and run.json into OUT.
"""

simulate = Command("geocontact.analyses.prosthesis.simulate.result:simulate", ProsthesisSimulateOptions, HELP)
