r"""A study of a shoulder exoskeleton: `geocontact shoulder study`, `gc.shoulder.study`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> text = '[tasks.T1]\ntool = { value = 1.3, unit = "kg" }\npush = { value = 35, unit = "N" }\n'
>>> text += '[persons.P1]\nmass = { value = 82, unit = "kg" }\nsex = "male"\ndominant = "right"\n'
>>> text += 'upper_arm = { value = 296, unit = "mm" }\n[[trials]]\nname = "t1"\nperson = "P1"\ntask = "T1"\n'
>>> text += 'markers = "meshes/overhead_P1T1S100/markers.trc"\ntool = "meshes/overhead_P1T1S100/tool.csv"\n'
>>> _ = Path("study.toml").write_text(text + 'level = "100%"\n')
>>> result = gc.shoulder.study("study.toml")
>>> sorted(result.tables())
['differences', 'errors', 'passive', 'summary']
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.shoulder.study.read import read
from geocontact.analyses.shoulder.study.run import run

study = Job("shoulder study", StudyOptions, read, run)
