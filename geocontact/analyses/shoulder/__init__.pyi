"""Names of `geocontact.analyses.shoulder`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.shoulder.compare.result import compare
from geocontact.analyses.shoulder.optimise.result import optimise
from geocontact.analyses.shoulder.simulate.result import simulate
from geocontact.analyses.shoulder.study.result import study

__all__ = ["compare", "optimise", "simulate", "study"]
