"""`geocontact knee settle`."""

from __future__ import annotations

from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.cli.command import Command

HELP = """Contact equilibrium of a knee implant: flexion and load given, the rest settles on an elastic foundation.

Writes settle.csv, poses.csv and settled.mot (motions for `geocontact area`), a figure, report.html and run.json into
OUT, contact_loads.mot and .xml with `bodies` (external loads for OpenSim), and pressures for ParaView with `paraview`.
"""

settle = Command("geocontact.analyses.knee.settle.result:settle", SettleOptions, HELP)
