"""An exoskeleton chosen for standing up: `geocontact sit-to-stand design`, `gc.sit_to_stand.design`.

>>> import geocontact as gc
>>> held_out, planted = "meshes/standing_up_held_out/study.toml", "meshes/standing_up_exoskeleton/truth.csv"
>>> result = gc.sit_to_stand.design(held_out, parameters=planted, vary="share", nodes=5)
>>> print(result.sentences[0])
peak force of the strap, smooth: without help … N, chosen … N
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.design.read import read
from geocontact.analyses.sit_to_stand.design.run import run

design = Job("sit-to-stand design", StandingDesignOptions, read, run)
