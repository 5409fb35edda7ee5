"""A model made to measure from a static trial: `geocontact scale`, `gc.scale`.

>>> import geocontact as gc
>>> static = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim").write("virtual") / "markers.trc"
>>> result = gc.scale(static, model="meshes/leg.osim", mass=70.0)
>>> result
scaled: no body; markers 25.8 mm from the model, root mean square, and 50.3 mm at most, foot_r2 at 0 s
(OpenSim advises less than 10 and 20 mm)
warning: virtual/markers.trc: foot_r2 moves 491 mm away from its mean: is this standing still?
warning: markers are 25.8 mm from the model, root mean square, and 50.3 mm at most, foot_r2 at 0 s (OpenSim
advises less than 10 and 20 mm): check where foot_r2 is on the model and in the recording, the scaling, and
exchanged markers
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.motion.scale.read import read
from geocontact.analyses.motion.scale.run import run

scale = Job("scale", ScaleOptions, read, run)
