"""`geocontact elbow design`."""

from __future__ import annotations

from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.cli.command import Command

HELP = """Which offsets of an exoskeleton's axis, and which stroke of a compensation joint, keep |F| under a limit.

For the elbow, and for the knee, the hip or any joint of one degree of freedom; slow motion. Writes design.json,
map.csv, boundary.csv, sensitivity.csv, force.csv, design.png, design.svg, report.html and run.json into OUT.
"""

design = Command("geocontact.analyses.misalignment.design.result:design", DesignOptions, HELP)
