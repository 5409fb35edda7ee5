"""Names of `geocontact.analyses.prosthesis`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.prosthesis.calibrate.job import calibrate
from geocontact.analyses.prosthesis.compare.job import compare
from geocontact.analyses.prosthesis.design.job import design
from geocontact.analyses.prosthesis.scale.job import scale
from geocontact.analyses.prosthesis.simulate.job import simulate

__all__ = ["calibrate", "compare", "design", "scale", "simulate"]
