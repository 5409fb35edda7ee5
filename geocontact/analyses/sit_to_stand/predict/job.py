"""Motion and strap force of held-out trials: `geocontact sit-to-stand predict`, `gc.sit_to_stand.predict`.

>>> import geocontact as gc
>>> held_out, planted = "meshes/standing_up_held_out/study.toml", "meshes/standing_up_exoskeleton/truth.csv"
>>> given = {"parameters": planted, "against": "meshes/standing_up_exoskeleton/study.toml", "nodes": 5}
>>> gc.sit_to_stand.predict(held_out, **given).sentences[0]
"1 trial predicted: strap within … N, the person's angles within …° (largest RMSD)"

>>> import geocontact as gc
>>> held_out, planted = "meshes/standing_up_held_out/study.toml", "meshes/standing_up_exoskeleton/truth.csv"
>>> given = {"parameters": planted, "against": "meshes/standing_up_exoskeleton/study.toml", "nodes": 5}
>>> gc.sit_to_stand.compare(held_out, **given).sentences[0]
'P1: nearest by its first and last posture is T2'
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.read import read
from geocontact.analyses.sit_to_stand.predict.run import run

predict = Job("sit-to-stand predict", StandingPredictOptions, read, run)
