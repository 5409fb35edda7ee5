"""How the largest force spreads over people: `geocontact elbow population`, `gc.misalignment.population`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.analyses.misalignment.population.read import read
from geocontact.analyses.misalignment.population.run import run

population = Job("elbow population", PopulationOptions, read, run)
