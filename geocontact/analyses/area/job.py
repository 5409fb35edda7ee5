"""The area analysis, and the same analysis called for its pressures.

>>> import geocontact as gc
>>> femoral, insert = "meshes/femoral_component_right_coarse.stl", "meshes/tibial_insert_right_coarse.stl"
>>> result = gc.area(femoral, insert, unit="mm", motion="meshes/gait.csv", threshold=gc.mm(4), rule="clip")
>>> result
area of FIXED within 4 mm: 1773.3 … 2484.0 mm^2
least distance -0.047 mm in frame 55 of 101, 0.54 s (signed: negative is overlap)
>>> result.table()[["time [s]", "area_fixed [mm^2]"]].head(2).round(2)
   time [s]  area_fixed [mm^2]
0      0.00            2397.72
1      0.01            2396.87

>>> import geocontact as gc
>>> femoral, insert = "meshes/femoral_component_right_coarse.stl", "meshes/tibial_insert_right_coarse.stl"
>>> layer = {"modulus": gc.MPa(500), "poisson": 0.46, "piece": gc.mm(1)}
>>> result = gc.pressure(femoral, insert, unit="mm", motion="meshes/gait.csv", rule="clip", **layer)
>>> result.sentences[-1]
'linear foundation: force up to 47.5 N, pressure up to 8.00 MPa'
"""

from __future__ import annotations

from geocontact.analyses.area.options import AreaOptions, PressureOptions
from geocontact.analyses.area.read import read
from geocontact.analyses.area.run import run
from geocontact.analyses.job import Job

area = Job("area", AreaOptions, read, run)
pressure = Job("area", PressureOptions, read, run)
