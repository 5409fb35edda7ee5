"""Joint moments and forces of a recorded motion: `geocontact id`, `gc.inverse_dynamics`.

>>> import geocontact as gc
>>> result = gc.inverse_dynamics("meshes/leg_swing.mot", model="meshes/leg.osim")
>>> result.sentences[0]
'101 frames; most at hip_z_moment, 26.8 N m; left over at the joint to the ground: 264 N at most, 117.0% of
the weight, as nothing but gravity acts'
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.read import read
from geocontact.analyses.motion.inverse_dynamics.run import run

inverse_dynamics = Job("id", IdOptions, read, run)
