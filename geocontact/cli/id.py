"""`geocontact id`."""

from __future__ import annotations

from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.cli.command import Command

HELP = """Joint moments and forces of a recorded motion: Newton and Euler, with the measured ground reactions.

Writes id.sto (for OpenSim), id.json with what is left over at the joint to the ground, cycles.csv where heel strikes
are known, report.html (a moving skeleton) and run.json into OUT. OpenSim's own set-up file
takes the place of inputs and options: --setup FILE; options that are typed beside it count instead of its own.
"""

inverse_dynamics = Command("geocontact.analyses.motion.inverse_dynamics.result:inverse_dynamics", IdOptions, HELP)
