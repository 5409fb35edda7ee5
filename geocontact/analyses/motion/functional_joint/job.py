"""Centre or axis of a joint from markers: `geocontact joint`, `gc.functional_joint`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.analyses.motion.functional_joint.read import read
from geocontact.analyses.motion.functional_joint.run import run

functional_joint = Job("joint", JointOptions, read, run)
