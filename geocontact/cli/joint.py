"""`geocontact joint`."""

from __future__ import annotations

from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.cli.command import Command

HELP = """Centre or axis of a joint from how the markers of two segments move against each other (SCoRE, SARA).

Writes joint.json, joint.csv, markers.trc [mm] with the joint as a marker, and run.json into OUT.
"""

joint = Command("geocontact.analyses.motion.functional_joint.result:functional_joint", JointOptions, HELP)
