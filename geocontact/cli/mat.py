"""`geocontact mat`."""

from __future__ import annotations

from geocontact.analyses.mat.options import MatOptions
from geocontact.cli.command import Command

HELP = """Pressures of a mat on the surface of a body scan: force, moment, centre of pressure and area over time.

Writes wrench.csv, uncertainty.csv, cells.csv, frames_cells.csv, segments.csv with `segment`, registration.csv with
`body_landmarks`, agreement.csv with `compare`, mat_on_surface.vtp, report.html, mat.png, mat.svg, run.json.
"""

mat = Command("geocontact.analyses.mat.result:mat", MatOptions, HELP)
