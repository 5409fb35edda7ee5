"""`geocontact shoulder simulate`."""

from __future__ import annotations

from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.cli.command import Command

HELP = """Motion and interface forces of a shoulder exoskeleton along recorded human motion, by its own dynamics.

Writes right.csv and left.csv, numbers.csv with the source of every number of the device, sensitivity.csv with
`sensitivity`, angles.sto, interface_forces.mot and .xml (external loads for OpenSim and `geocontact id`), paraview,
plane (for `geocontact gap gather`), a figure, report.html (moving arms with forces) and run.json into OUT.
"""

simulate = Command("geocontact.analyses.shoulder.simulate.result:simulate", ShoulderSimulateOptions, HELP)
