"""Contact forces from the load cells of an implant: `geocontact loadcells`, `gc.load_cells`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> time = np.linspace(0.0, 1.0, 101)
>>> cells = {name: 300.0 * np.sin(np.pi * time) for name in ("PM [N]", "AM [N]", "AL [N]", "PL [N]")}
>>> pd.DataFrame({"time [s]": time} | cells).to_csv("cells.csv", index=False)
>>> result = gc.load_cells("cells.csv")
>>> result
largest forces: medial 604.6 N, lateral 595.4 N, total 1200.0 N (total at 0.5 s)
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.loadcells.options import LoadcellOptions
from geocontact.analyses.loadcells.read import read
from geocontact.analyses.loadcells.run import run

load_cells = Job("loadcells", LoadcellOptions, read, run)
