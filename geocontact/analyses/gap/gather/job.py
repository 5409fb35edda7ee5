r"""A gap case of recordings: `geocontact gap gather`, `gc.gather`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> from pathlib import Path
>>> time = np.linspace(0.0, 1.0, 51)
>>> forces = pd.DataFrame({"time [s]": time, "medial [N]": 800.0 + 100.0 * time, "lateral [N]": 500.0 - 50.0 * time})
>>> forces.to_csv("forces.csv", index=False)
>>> areas = {"area_medial [mm^2]": 60.0 + 5.0 * time, "area_lateral [mm^2]": 40.0 - 2.0 * time}
>>> pd.DataFrame({"time [s]": time, **areas}).to_csv("areas.csv", index=False)
>>> text = 'format = 1\nsystem = "knee"\ncalibration = ["t1"]\nevaluation = ["t2"]\nconstants = { R = 0.037 }\n'
>>> text += 'parameters.E_star = { start = 1e7, lower = 1e5, upper = 1e9, unit = "Pa" }\n'
>>> for name in ("t1", "t2"):
...     text += f'[from.{name}]\ninputs = "areas.csv"\nforces = "forces.csv"\n'
>>> _ = Path("gather.toml").write_text(text)
>>> print(gc.gather("gather.toml").sentences[0])
2 trials
"""

from __future__ import annotations

from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.read import read
from geocontact.analyses.gap.gather.run import run
from geocontact.analyses.job import Job

gather = Job("gap gather", GatherOptions, read, run)
