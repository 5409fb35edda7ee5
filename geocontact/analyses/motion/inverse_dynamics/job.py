"""Joint moments and forces of a recorded motion: `geocontact id`, `gc.inverse_dynamics`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.read import read
from geocontact.analyses.motion.inverse_dynamics.run import run

inverse_dynamics = Job("id", IdOptions, read, run)
