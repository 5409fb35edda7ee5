"""`geocontact scale`."""

from __future__ import annotations

from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.cli.command import Command

HELP = """A model made to measure from a static trial: sizes of bodies, mass, places of markers.

Writes scaled.osim (for ik, id and OpenSim; its defaults are the static pose), scale.json and run.json into OUT.
OpenSim's own set-up file takes the place of inputs and options: --setup FILE; options that are typed beside it count
instead of its own.
"""

scale = Command("geocontact.analyses.motion.scale.result:scale", ScaleOptions, HELP)
