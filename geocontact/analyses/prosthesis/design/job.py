"""Which foot for whom: `geocontact prosthesis design`, `gc.prosthesis.design`.

>>> import geocontact as gc
>>> trial = "meshes/gait_P1_medium_1/"
>>> given = {"static": trial + "standing.trc", "mass": 77.3, "plates": trial + "plates.mot", "plate": "own_force"}
>>> result = gc.prosthesis.design(trial + "walking.trc", feet=6, walks=1, **given)
>>> print(result.sentences[0])
radius of the roll-over shape, nearest to … m: …
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.read import read
from geocontact.analyses.prosthesis.design.run import run

design = Job("prosthesis design", ProsthesisDesignOptions, read, run)
