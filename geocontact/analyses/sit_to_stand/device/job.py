"""The exoskeleton's own torque: `geocontact sit-to-stand device`, `gc.sit_to_stand.device`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.device.options import StandingDeviceOptions
from geocontact.analyses.sit_to_stand.device.read import read
from geocontact.analyses.sit_to_stand.device.run import run

device = Job("sit-to-stand device", StandingDeviceOptions, read, run)
