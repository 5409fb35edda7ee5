"""Motion and strap force of held-out trials: `geocontact sit-to-stand predict`, `gc.sit_to_stand.predict`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.read import read
from geocontact.analyses.sit_to_stand.predict.run import run

predict = Job("sit-to-stand predict", StandingPredictOptions, read, run)
