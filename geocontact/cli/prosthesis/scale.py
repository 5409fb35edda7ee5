"""`geocontact prosthesis scale`."""

from __future__ import annotations

from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.cli.command import Command

HELP = """A model of both legs of a person with a below-knee prosthesis, from markers while standing, for OpenSim.

Writes amputee.osim (socket and keel free, with springs), amputee_ik.osim (both held, for ik), segments.csv, joints.csv,
markers.csv, numbers.csv, report.html and run.json into OUT.
"""

scale = Command("geocontact.analyses.prosthesis.scale.result:scale", ProsthesisScaleOptions, HELP)
