"""A shoulder exoskeleton along human motion: `geocontact shoulder simulate`, `gc.shoulder.simulate`.

>>> import geocontact as gc
>>> result = gc.shoulder.simulate("meshes/overhead_P1T1S100/markers.trc", level=1.0, side="right")
>>> result
right arm: elevation up to 113.9 deg (shoulder 120.9), supporting force 6.7 … 56.5 N, slip 179 mm
warning: no `person`: the device is adjusted to an upper arm of 300 mm and shoulders 400 mm wide (invented)
warning: T10 is taken to lie straight below Lucy_MC: no span of upright stance was named
warning: lucy: 54 of 63 numbers are invented, see numbers.csv
warning: right arm: passive_1 is at a stop for 66% of the time, first at 0.00 s
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.read import read
from geocontact.analyses.shoulder.simulate.run import run

simulate = Job("shoulder simulate", ShoulderSimulateOptions, read, run)
