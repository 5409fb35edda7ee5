"""`geocontact ik`."""

from __future__ import annotations

from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.cli.command import Command

HELP = """Joint angles from recorded markers: weighted least squares in every frame, limits of the model kept.

Writes ik.mot (degrees and metres, for OpenSim), markers.csv (distance of each marker from the model), knees.csv with
`knee`, cycles.csv where heel strikes are known, ik.json, report.html (a moving skeleton) and run.json into OUT.
OpenSim's own set-up file takes the place of inputs and options: --setup FILE; options that are typed beside it count
instead of its own.
"""

ik = Command("geocontact.analyses.motion.inverse_kinematics.result:inverse_kinematics", IkOptions, HELP)
