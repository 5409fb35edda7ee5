"""Support profiles by linear programs: `geocontact shoulder optimise`, `gc.shoulder.optimise`.

>>> import geocontact as gc
>>> result = gc.shoulder.optimise()
>>> result.sentences[0]
"36.1% of the shoulders' torque is taken away in the simulation (36.1% planned) without ever pushing an arm up,
nor in 95% of the draws of the model's errors that it was chosen with; one factor for all tasks, hands and phases
takes 19.2%"
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.read import read
from geocontact.analyses.shoulder.optimise.run import run

optimise = Job("shoulder optimise", ShoulderOptimiseOptions, read, run)
