"""Names of `geocontact.analyses.shoulder`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.shoulder.compare.job import compare
from geocontact.analyses.shoulder.optimise.job import optimise
from geocontact.analyses.shoulder.simulate.job import simulate
from geocontact.analyses.shoulder.study.job import study

__all__ = ["compare", "optimise", "simulate", "study"]
