"""A model of the elbow beside recordings: `geocontact elbow compare`, `gc.misalignment.compare`.

>>> import geocontact as gc
>>> trials = gc.misalignment.simulate(rate=20.0, seconds=20.0, trials=2, seed=3).write("trials")
>>> first, second = sorted(trials.glob("locked_*.csv"))
>>> known = {"l": gc.mm(169), "z": gc.mm(127)}
>>> fit = gc.misalignment.identify([first], known=known, bootstrap=0).write("fit") / "elbow.json"
>>> gc.misalignment.compare([second], fit=fit)
locked_2, force: MAE 0.644, RMSE 0.809 N, R² 0.947
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.compare.pairs import read
from geocontact.analyses.misalignment.compare.result import run

compare = Job("elbow compare", CompareOptions, read, run)
