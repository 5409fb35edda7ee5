"""`geocontact area`."""

from __future__ import annotations

from geocontact.analyses.area.options import AreaOptions
from geocontact.cli.command import Command

HELP = """Contact area of two rigid surfaces over a motion, with certified bounds.

Writes area.csv, report.html, area.png, area.svg and run.json into OUT, and pressure.csv with `pressure`. A point counts
as in contact when its signed distance to the other body is not above the threshold; against an open body distances are
unsigned, and the table says so.
"""

area = Command("geocontact.analyses.area.result:area", AreaOptions, HELP, rest="motion")
