"""A person with a below-knee prosthesis made to measure: `geocontact prosthesis scale`, `gc.prosthesis.scale`.

>>> import geocontact as gc
>>> stood = "meshes/amputee_P1/"
>>> person = {"mass": 77.3, "height": 1.81}
>>> result = gc.prosthesis.scale(stood + "standing.trc", functional=stood + "functional.trc", **person)
>>> result
both legs of 77.3 kg in 17 bodies with 36 coordinates, pelvis with all above it 46.9 kg, residual limb 1.78
kg
5 of 5 joint centres from the functional trial
markers of the functional trial 3.7 mm from the model, root mean square, and 11.7 mm at most, LKNE at 37.8 s
(OpenSim advises less than 20 and 40 mm)
warning: 8 of 91 numbers of the segments are invented, see numbers.csv
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.scale.read import read
from geocontact.analyses.prosthesis.scale.run import run

scale = Job("prosthesis scale", ProsthesisScaleOptions, read, run)
