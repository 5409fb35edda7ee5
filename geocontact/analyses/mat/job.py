"""A pressure mat on a body scan: `geocontact mat`, `gc.mat`.

>>> import geocontact as gc
>>> mat = "meshes/mat_thigh_16x8/"
>>> given = {"layout": mat + "layout.toml", "landmarks": mat + "landmarks.csv", "cutoff": 0.0}
>>> result = gc.mat(mat + "frames.csv", surface="meshes/thigh.stl", unit="mm", **given)
>>> result
force up to 79.6 N at 1.1 s, pressure up to 29.1 kPa, area up to 76 cm²
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.read import read
from geocontact.analyses.mat.run import run

mat = Job("mat", MatOptions, read, run)
