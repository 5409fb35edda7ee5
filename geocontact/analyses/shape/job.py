"""Cylinder, sphere or plane fitted to a surface: `geocontact fit`, `gc.fit_shape`.

>>> import geocontact as gc
>>> result = gc.fit_shape("meshes/sphere_r20.stl", shape="sphere", unit="mm")
>>> result
sphere_r20.stl: sphere, radius 20.000 mm (95 % 20.000 … 20.000), rms 0.000 mm over 1442 points, 1442 of them
inliers
>>> round(result.fit.radius, 6)
0.02
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.analyses.shape.read import read
from geocontact.analyses.shape.run import run

fit_shape = Job("fit", ShapeOptions, read, run)
