"""`geocontact cop`."""

from __future__ import annotations

from geocontact.analyses.cop.options import CopOptions
from geocontact.cli.command import Command

HELP = """Centre of pressure, force and free moment of a foot that stands on spheres, over a motion.

Writes cop.csv, zones.csv, cop.png, cop.svg, report.html and run.json into OUT, and comparison.csv with `compare`.
"""

cop = Command("geocontact.analyses.cop.result:centre_of_pressure", CopOptions, HELP)
