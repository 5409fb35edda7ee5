"""Virtual markers of a model along a motion: `geocontact markers`, `gc.virtual_markers`.

>>> import geocontact as gc
>>> result = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim")
>>> result
16 markers in 101 frames
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.virtual_markers.options import MarkersOptions
from geocontact.analyses.motion.virtual_markers.run import read, run

virtual_markers = Job("markers", MarkersOptions, read, run)
