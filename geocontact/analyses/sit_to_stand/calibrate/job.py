"""Contacts from trials of standing up: `geocontact sit-to-stand calibrate`, `gc.sit_to_stand.calibrate`.

>>> import geocontact as gc
>>> result = gc.sit_to_stand.calibrate("meshes/standing_up/study.toml", nodes=5, resamples=0)
>>> print(result.sentences[0])
3 trials: ground reaction within … N, centre of pressure within … mm, angles within …° (largest RMSD of a trial)
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.read import read
from geocontact.analyses.sit_to_stand.calibrate.run import run

calibrate = Job("sit-to-stand calibrate", StandingCalibrateOptions, read, run)
