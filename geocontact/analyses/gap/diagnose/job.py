r"""Which effect a model lacks: `geocontact gap diagnose`, `gc.diagnose`.

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
>>> gc.diagnose("case").sentences[0]
'damping is missing; it sits in torque (phase 31–100 %, fast part of angle); adding it removes 92 % [87, 95]
of the error on trials not used; 0 % stays unexplained'
"""

from __future__ import annotations

from geocontact.analyses.gap.diagnose.many import read_folders, run_many
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions, ManyOptions
from geocontact.analyses.gap.diagnose.read import read
from geocontact.analyses.gap.diagnose.run import run
from geocontact.analyses.job import Job

diagnose = Job("gap diagnose", DiagnoseOptions, read, run)
diagnose_many = Job("gap diagnose", ManyOptions, read_folders, run_many)
