"""Centre or axis of a joint from markers: `geocontact joint`, `gc.functional_joint`.

>>> import geocontact as gc
>>> leg = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim").write("leg")
>>> thigh, shank = (",".join(f"{body}_r{k}" for k in range(3)) for body in ("femur", "tibia"))
>>> gc.functional_joint(leg / "markers.trc", first=thigh, second=shank, axis=True).sentences[0]
"101 frames, 60 deg of turn: the segments' axis is 0.0 mm off itself, root mean square; halves of the trial give it 0.0
mm apart"
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.analyses.motion.functional_joint.read import read
from geocontact.analyses.motion.functional_joint.run import run

functional_joint = Job("joint", JointOptions, read, run)
