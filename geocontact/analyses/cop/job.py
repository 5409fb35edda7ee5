"""Centre of pressure, force and free moment of a foot on spheres: `geocontact cop`, `gc.centre_of_pressure`.

>>> import geocontact as gc, pandas as pd
>>> heel, ball = (0.0, 0.012, 0.0, 0.012, "heel"), (0.16, 0.012, 0.0, 0.012, "ball")
>>> columns = ["px [m]", "py [m]", "pz [m]", "radius [m]", "zone"]
>>> pd.DataFrame([heel, ball], columns=columns).to_csv("spheres.csv", index=False)
>>> fall = {"time [s]": [0.0, 0.1, 0.2], "tx [mm]": 0, "ty [mm]": [-2, -3, -4], "tz [mm]": 0}
>>> turn = {"rx [deg]": 0, "ry [deg]": 0, "rz [deg]": [0.5, 0.0, -0.5]}
>>> pd.DataFrame(fall | turn).to_csv("foot.csv", index=False)
>>> result = gc.centre_of_pressure("spheres.csv", motion="foot.csv", order="XYZ", stiffness=8e4, damping=0.0)
>>> result
normal force up to 258.0 N; a centre of pressure in 3 of 3 frames
warning: numbers of the force law that were not given are assumed: n = 1.2, mu_s = 0.9, mu_k = 0.7, v_th =
0.25 m/s
"""

from __future__ import annotations

from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.cop.read import read
from geocontact.analyses.cop.run import run
from geocontact.analyses.job import Job

centre_of_pressure = Job("cop", CopOptions, read, run)
