"""Names of `geocontact.analyses.knee`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.knee.settle.result import settle

__all__ = ["settle"]
