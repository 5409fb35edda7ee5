"""An exoskeleton chosen for standing up: `geocontact sit-to-stand design`, `gc.sit_to_stand.design`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.design.read import read
from geocontact.analyses.sit_to_stand.design.run import run

design = Job("sit-to-stand design", StandingDesignOptions, read, run)
