"""Gap cases whose effect is known and withheld: synthetic, made by code that shares nothing with the candidates.

It knows numpy, scipy, numba, pandas and `geocontact.data`, nothing else of the package: an import contract says so.
Base models are written a second time from their definition, trajectories are continuous functions of time, and every
effect follows another equation than the candidate that is to find it (each plan states both).
"""

from geocontact.gap_benchmark.synthetic.cases import synthetic_case
from geocontact.gap_benchmark.synthetic.catalogue import LABORATORIES
from geocontact.gap_benchmark.synthetic.label import KINDS, Kind, Label, SyntheticCase

__all__ = ["KINDS", "LABORATORIES", "Kind", "Label", "SyntheticCase", "synthetic_case"]
