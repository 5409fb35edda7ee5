"""`geocontact sit-to-stand device`."""

from __future__ import annotations

from geocontact.analyses.sit_to_stand.device.options import StandingDeviceOptions
from geocontact.cli.command import Command

HELP = """Dynamic parameters of a leg exoskeleton from a motion without a person, and its own torque in a trial.

Writes parameters.csv (value, interval, and whether the motion tells it by itself), unloaded.csv (torques of the motors
and of the fit), numbers.csv (all that ran), with a trial torque.csv and torques.sto, a figure, report.html and run.json
into OUT.
"""

device = Command("geocontact.analyses.sit_to_stand.device.result:device", StandingDeviceOptions, HELP)
