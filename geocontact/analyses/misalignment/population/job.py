r"""How the largest force spreads over people: `geocontact elbow population`, `gc.misalignment.population`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> text = 'k = { value = 222, unit = "N/m" }\nl = { value = 169, unit = "mm" }\nz = { value = 127, unit = "mm" }\n'
>>> text += "".join(f'{name} = {{ unit = "mm", normal = {{ mean = 0, sd = 15 }} }}\n' for name in "xy")
>>> _ = Path("people.toml").write_text(text)
>>> result = gc.misalignment.population("people.toml", range=gc.deg(0, 120), limit=10.0, samples=20_000)
>>> print(result.sentences[0])
largest |F| of 20000 synthetic people: median … N (… … …), 95 % below … N (… … …)
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.population.drawn import read
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.analyses.misalignment.population.result import run

population = Job("elbow population", PopulationOptions, read, run)
