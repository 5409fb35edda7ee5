"""`geocontact elbow population`."""

from __future__ import annotations

from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.cli.command import Command

HELP = """Distribution of the largest force over people whose offsets and attachment differ.

Writes population.json, quantiles.csv, exceedance.csv, influence.csv, population.png, population.svg, report.html and
run.json into OUT. All samples are synthetic: drawn, not measured.
"""

population = Command("geocontact.analyses.misalignment.population.result:population", PopulationOptions, HELP)
