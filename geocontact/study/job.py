r"""Studies: `geocontact cohort`, `gc.cohort`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> text = 'analysis = "fit"\noptions = { shape = "sphere", unit = "mm" }\n'
>>> text += 'sweep = { mesh = ["meshes/sphere_r18.stl", "meshes/sphere_r20.stl"] }\n'
>>> _ = Path("study.toml").write_text(text)
>>> gc.cohort("study.toml", workers=1)
2 of 2 trials of fit have results, 2 of them new
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.study.options import CohortOptions
from geocontact.study.read import read
from geocontact.study.run import run

cohort = Job("cohort", CohortOptions, read, run)
