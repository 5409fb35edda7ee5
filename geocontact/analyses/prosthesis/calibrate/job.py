"""The sole's numbers from a stance: `geocontact prosthesis calibrate`, `gc.prosthesis.calibrate`.

>>> import geocontact as gc
>>> trial = "meshes/gait_P1_medium_1/"
>>> given = {"static": trial + "standing.trc", "mass": 77.3, "plates": trial + "plates.mot", "plate": "own_force"}
>>> result = gc.prosthesis.calibrate(trial + "walking.trc", starts=0, **given)
>>> print(result.sentences[0])
vertical force within … % of body weight (R² …), centre of pressure within … % of the foot (R² …); …
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.calibrate.read import read
from geocontact.analyses.prosthesis.calibrate.run import run

calibrate = Job("prosthesis calibrate", ProsthesisCalibrateOptions, read, run)
