"""Names of `geocontact.analyses.misalignment`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.misalignment.compare.job import compare
from geocontact.analyses.misalignment.design.job import design
from geocontact.analyses.misalignment.identify.job import identify
from geocontact.analyses.misalignment.population.job import population
from geocontact.analyses.misalignment.simulate.job import simulate

__all__ = ["compare", "design", "identify", "population", "simulate"]
