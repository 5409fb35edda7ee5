r"""The analysis of a contact equilibrium.

>>> import geocontact as gc
>>> from pathlib import Path
>>> rows = Path("meshes/gait.csv").read_text().splitlines()[:2]
>>> _ = Path("first.csv").write_text("\n".join(rows))
>>> moving, fixed = (f"meshes/{name}_right_coarse.stl" for name in ("femoral_component", "tibial_insert"))
>>> layer = {"modulus": gc.MPa(463), "poisson": 0.46, "region": "ny>0.25"}
>>> result = gc.knee.settle(moving, fixed, unit="mm", motion="first.csv", side="right", load=2000.0, **layer)
>>> print(f"{result.table()['peak [MPa]'][0]:.1f} MPa")
31.8 MPa
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.knee.settle.equilibrium import read
from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.analyses.knee.settle.result import run

settle = Job("knee settle", SettleOptions, read, run)
