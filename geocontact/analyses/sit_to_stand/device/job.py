"""The exoskeleton's own torque: `geocontact sit-to-stand device`, `gc.sit_to_stand.device`.

>>> import geocontact as gc
>>> unloaded = "meshes/standing_up_exoskeleton/unloaded_"
>>> gc.sit_to_stand.device(unloaded + "coordinates.sto", motors=unloaded + "motors.sto")
15 combinations of 18 parameters told, 11 parameters by themselves; 0.22 N m are left of the motors' torques (root mean
square)
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.sit_to_stand.device.options import StandingDeviceOptions
from geocontact.analyses.sit_to_stand.device.read import read
from geocontact.analyses.sit_to_stand.device.run import run

device = Job("sit-to-stand device", StandingDeviceOptions, read, run)
