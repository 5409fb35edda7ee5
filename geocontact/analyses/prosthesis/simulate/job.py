"""A stance of a below-knee prosthesis: `geocontact prosthesis simulate`, `gc.prosthesis.simulate`.

>>> import geocontact as gc
>>> trial = "meshes/gait_P1_medium_1/"
>>> plates = {"plates": trial + "plates.mot", "plate": "own_force", "other_plate": "other_force"}
>>> result = gc.prosthesis.simulate(trial + "walking.trc", static=trial + "standing.trc", mass=77.3, **plates)
>>> result
stance of 0.73 s at the fulcrum of 117 mm: vertical force up to 1.30 BW, ankle moment up to 100 N m, keel
stores 11.0 J
against the plate: R² 0.92, 7.8% BW; centre of pressure R² 1.00, 1.1% of the foot; stance -6 ms
warning: the hip's centre is that of a regression; a `functional` trial tells it better
warning: 79 of 142 numbers of leg and foot are invented, see numbers.csv
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.read import read
from geocontact.analyses.prosthesis.simulate.run import run

simulate = Job("prosthesis simulate", ProsthesisSimulateOptions, read, run)
