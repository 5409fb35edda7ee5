r"""Would an effect be found? `geocontact gap inject`, `gc.inject`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> from pathlib import Path
>>> Path("case/trials").mkdir(parents=True)
>>> time, noise = 0.04 * np.arange(160), np.random.default_rng(3)
>>> for k in range(1, 6):
...     angle = 0.3 * np.sin((2.0 + 0.4 * k) * time) + 0.08 * np.sin((5.0 + k) * time)
...     torque = 60.0 * angle + 3.0 * np.gradient(angle, time) + noise.normal(0.0, 0.2, 160)
...     trial = pd.DataFrame({"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})
...     trial.to_csv(f"case/trials/t{k}.csv", index=False)
>>> text = 'format = 1\nsystem = "geocontact.systems.elastic_joint.model:JOINT"\n'
>>> text += 'calibration = ["t1", "t2", "t3"]\nevaluation = ["t4", "t5"]\n[noise]\ntorque = 0.2\n'
>>> text += '[parameters.k]\nstart = 50.0\nlower = 10.0\nupper = 200.0\nunit = "N m/rad"\n'
>>> _ = Path("case/case.toml").write_text(text)
>>> gc.inject("case", effect="damping", size=1.0).sentences[0]
'injected damping (damping.b = 0.9232 N m s/rad, damping.exponent = 1 -); it makes a gap of 1 times the noise
floor'
"""

from __future__ import annotations

from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.analyses.gap.inject.read import read
from geocontact.analyses.gap.inject.run import run
from geocontact.analyses.job import Job

inject = Job("gap plant", InjectOptions, read, run)
