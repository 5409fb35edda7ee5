"""A simulated arm beside logger and mat: `geocontact shoulder compare`, `gc.shoulder.compare`.

>>> import geocontact as gc
>>> trial = "meshes/overhead_P1T1S100/markers.trc"
>>> full = gc.shoulder.simulate(trial, level=1.0, side="right").table("right")
>>> recorded = full[["time [s]", "elevation [deg]", "supporting [N]"]]
>>> recorded.rename(columns={"supporting [N]": "force [N]"}).to_csv("recorded.csv", index=False)
>>> half = gc.shoulder.simulate(trial, level=0.5, side="right").write("half") / "right.csv"
>>> gc.shoulder.compare(half, "recorded.csv")
elevation, all: MAE 4.02, RMSD 4.51 deg
elevation, work: MAE 4.93, RMSD 5.12 deg
force, all: MAE 13.4, RMSD 14.7 N
force, work: MAE 16.1, RMSD 16.6 N
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.analyses.shoulder.compare.read import read
from geocontact.analyses.shoulder.compare.run import run

compare = Job("shoulder compare", ShoulderCompareOptions, read, run)
