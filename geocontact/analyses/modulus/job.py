"""E* of a contact from its area and its force: `geocontact modulus`, `gc.modulus`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> time, area = np.linspace(0.0, 1.0, 11), np.linspace(100.0, 200.0, 11)
>>> areas = {"time [s]": time, "threshold [mm]": 1.0, "area_fixed [mm^2]": area}
>>> pd.DataFrame(areas).to_csv("area.csv", index=False)
>>> force = 4 / 3 * gc.MPa(2) * (area * 1e-6 / np.pi) ** 1.5 / gc.mm(34)
>>> pd.DataFrame({"time [s]": time, "total [N]": force}).to_csv("forces.csv", index=False)
>>> gc.modulus("area.csv", "forces.csv", radius=gc.mm(34))
total: E* 2 MPa (95 % 2 … 2), RMSE 0 N, R² 1.00
E and ν are one number here: area and force tell E* = E/(1 - ν²), and E only for a stated ν
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.analyses.modulus.read import read
from geocontact.analyses.modulus.run import run

modulus = Job("modulus", ModulusOptions, read, run)
