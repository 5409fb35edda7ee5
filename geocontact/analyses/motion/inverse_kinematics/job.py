"""Joint angles from recorded markers: `geocontact ik`, `gc.inverse_kinematics`.

>>> import geocontact as gc
>>> markers = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim").write("virtual") / "markers.trc"
>>> result = gc.inverse_kinematics(markers, model="meshes/leg.osim")
>>> result
101 frames, 16 markers: 0.0 mm from the model, root mean square, and 0.0 mm at most, foot_r2 at 0.57 s
(OpenSim advises less than 20 and 40 mm)
>>> list(result.table("coordinates"))[:3]
['time [s]', 'tilt [deg]', 'list [deg]']
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.read import read
from geocontact.analyses.motion.inverse_kinematics.run import run

inverse_kinematics = Job("ik", IkOptions, read, run)
