"""Joint angles from recorded markers: `geocontact ik`, `gc.inverse_kinematics`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.read import read
from geocontact.analyses.motion.inverse_kinematics.run import run

inverse_kinematics = Job("ik", IkOptions, read, run)
