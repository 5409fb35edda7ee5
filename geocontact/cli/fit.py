"""`geocontact fit`."""

from __future__ import annotations

from geocontact.analyses.shape.options import ShapeOptions
from geocontact.cli.command import Command

HELP = """Cylinder, sphere or plane that fits a surface best, by distance and robustly, with the map of the residuals.

Writes fit.json, fit.png, fit.svg, report.html and run.json into OUT, and profile.csv, profile.png, profile.svg with
`profile`. Which faces count decides the radius: say it with `region`.
"""

fit = Command("geocontact.analyses.shape.result:fit_shape", ShapeOptions, HELP)
