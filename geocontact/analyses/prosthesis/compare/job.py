r"""Many stances beside their plates: `geocontact prosthesis compare`, `gc.prosthesis.compare`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> trial = "meshes/gait_P1_medium_1/"
>>> text = f'[persons.P1]\nmass = {{ value = 77.3, unit = "kg" }}\nstatic = "{trial}standing.trc"\n'
>>> for name in ("low", "medium"):
...     place = f"meshes/gait_P1_{name}_1/"
...     text += f'[[trials]]\nname = "{name}"\nperson = "P1"\nsetting = "{name}"\nmarkers = "{place}walking.trc"\n'
...     text += f'plates = "{place}plates.mot"\nplate = "own_force"\nother_plate = "other_force"\n'
>>> _ = Path("study.toml").write_text(text)
>>> print("\n".join(gc.prosthesis.compare("study.toml", workers=1).sentences[:2]))
2 stances, 1 person, 2 settings of the foot
resultant force: R² 0.95, 6.4% BW; without a model mean of the others 11.2% BW, another setting 11.2% BW; better than
both on 2 of 2
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.read import read
from geocontact.analyses.prosthesis.compare.run import run

compare = Job("prosthesis compare", ProsthesisCompareOptions, read, run)
