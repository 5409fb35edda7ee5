"""Stiffness, link and offsets of an exoskeleton: `geocontact elbow fit`, `gc.misalignment.identify`.

>>> import geocontact as gc
>>> trials = gc.misalignment.simulate(rate=20.0, seconds=20.0, trials=2, seed=3).write("trials")
>>> locked = sorted(trials.glob("locked_*.csv"))
>>> known = {"l": gc.mm(169), "z": gc.mm(127)}
>>> result = gc.misalignment.identify(locked, known=known, bootstrap=0)
>>> {name: round(result.numbers[name], 3) for name in ("k", "x", "y")}
{'k': 234.884, 'x': 0.045, 'y': 0.059}
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.identify.inputs import read
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.identify.result import run

identify = Job("elbow fit", IdentifyOptions, read, run)
