"""Names of `geocontact.analyses.prosthesis`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.prosthesis.calibrate.result import calibrate
from geocontact.analyses.prosthesis.compare.result import compare
from geocontact.analyses.prosthesis.design.result import design
from geocontact.analyses.prosthesis.keel.result import keel
from geocontact.analyses.prosthesis.scale.result import scale
from geocontact.analyses.prosthesis.simulate.result import simulate
from geocontact.analyses.prosthesis.walk.result import walk

__all__ = ["calibrate", "compare", "design", "keel", "scale", "simulate", "walk"]
