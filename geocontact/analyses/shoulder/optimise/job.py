"""Support profiles by linear programs: `geocontact shoulder optimise`, `gc.shoulder.optimise`.

>>> import geocontact as gc
>>> result = gc.shoulder.optimise()
>>> result.sentences[0]
"51.4% of the shoulders' torque is taken away without ever pushing an arm up, as the human elevation has it;
one factor for all tasks, hands and phases takes 40.2%"
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.read import read
from geocontact.analyses.shoulder.optimise.run import run

optimise = Job("shoulder optimise", ShoulderOptimiseOptions, read, run)
