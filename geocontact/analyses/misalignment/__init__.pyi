"""Names of `geocontact.analyses.misalignment`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.misalignment.compare.result import compare
from geocontact.analyses.misalignment.design.result import design
from geocontact.analyses.misalignment.identify.result import identify
from geocontact.analyses.misalignment.population.result import population
from geocontact.analyses.misalignment.simulate.result import simulate

__all__ = ["compare", "design", "identify", "population", "simulate"]
