"""From implant and body-scan meshes, motion and pressure data to contact areas, contact forces and material properties.

One function for every job; each returns a result that says what was found::

    import geocontact as gc
    result = gc.area("femoral.stl", "tibial.stl", unit="mm", motion="gait.csv", threshold=gc.mm(4))
    print(result)                 # two sentences; a notebook shows them with the figure
    result.area                   # m^2, numpy; help(gc.area) lists the numbers of a result
    result.table(), result.write("out"), result.page("report.html")

SI units inside (m, rad, s, N, Pa): values enter with a unit argument or as `gc.mm(4)`; tables have the unit in each
column's name.
"""

from __future__ import annotations

import sys

from geocontact.data.stub_names import names_of_stub
from geocontact.data.version import VERSION

__version__ = VERSION
__getattr__, __dir__, __all__ = names_of_stub(sys.modules[__name__])
