"""Synthetic recordings of an exoskeleton at an elbow: `geocontact elbow simulate`, `gc.misalignment.simulate`.

>>> import geocontact as gc
>>> result = gc.misalignment.simulate(seconds=5.0, trials=1, seed=3)
>>> result
locked_1, synthetic: -10.0 … 8.1 N over 8 … 92°, 5 s
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.analyses.misalignment.simulate.result import run
from geocontact.analyses.misalignment.simulate.trials import read

simulate = Job("elbow simulate", SimulateOptions, read, run)
